// diagnostic_msgs/DiagnosticArray of ROS 2's common_interfaces, and its bytes. Pure; see ros2_messages.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kDiagnosticArrayType = "diagnostic_msgs::msg::dds_::DiagnosticArray_";

enum class DiagnosticLevel : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };

struct KeyValue {
  std::string key;
  std::string value;
};

struct DiagnosticStatus {
  DiagnosticLevel level = DiagnosticLevel::ok;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValue> values;
};

struct DiagnosticArray {
  Header header;
  std::vector<DiagnosticStatus> status;
};

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity.
void encode(const DiagnosticArray& message, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
