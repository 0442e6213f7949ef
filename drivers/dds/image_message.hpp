// sensor_msgs/CompressedImage of ROS 2's common_interfaces, and its bytes. Pure; see ros2_messages.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kCompressedImageType = "sensor_msgs::msg::dds_::CompressedImage_";

struct CompressedImage {
  Header header = {};
  std::string_view format = "jpeg";         // "jpeg" or "png"
  std::span<const std::uint8_t> data = {};  // of a whole file
};

// The same, looking into a payload.
struct CompressedImageView {
  RosTime stamp;
  std::string_view frame_id;
  std::string_view format;
  std::span<const std::uint8_t> data;
};

// Checks form only; `data` is whatever was sent. After a fault the content is unspecified.
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, CompressedImageView& message);

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity.
void encode(const CompressedImage& message, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
