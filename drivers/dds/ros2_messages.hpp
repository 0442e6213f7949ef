// The messages of ROS 2 that the gateway reads and writes, and their bytes. Pure: no DDS library, no clock.
// Layouts: std_msgs/Header, sensor_msgs/JointState, geometry_msgs/TransformStamped, tf2_msgs/TFMessage of ROS 2's
// common_interfaces; bytes: see cdr.hpp. Units are ROS 2's (REP 103): rad, m, s, Nm, N.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/cdr.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kJointStateType = "sensor_msgs::msg::dds_::JointState_";
inline constexpr std::string_view kTfMessageType = "tf2_msgs::msg::dds_::TFMessage_";
inline constexpr std::string_view kStringType = "std_msgs::msg::dds_::String_";

// More joints or transforms in one message are refused: no real one comes near, a hostile one may.
inline constexpr std::uint32_t kMaxJointsInMessage = 4096;
inline constexpr std::uint32_t kMaxTransformsInMessage = 4096;

// builtin_interfaces/Time: since 1970-01-01 UTC; all zero: no time given.
struct RosTime {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  friend bool operator==(const RosTime&, const RosTime&) = default;
};
// None for the zero stamp, times before 1970, and nanoseconds beyond 999,999,999.
[[nodiscard]] std::optional<std::int64_t> wall_clock_ns(RosTime time);
// Times that 32-bit seconds cannot hold give the zero stamp.
[[nodiscard]] RosTime ros_time(std::int64_t wall_clock_ns);

struct Header {
  RosTime stamp = {};
  std::string frame_id = {};
};

// sensor_msgs/JointState. `position`, `velocity` and `effort` are each empty or as long as `name`.
struct JointState {
  Header header = {};
  std::vector<std::string> name = {};
  std::vector<double> position = {};  // rad or m
  std::vector<double> velocity = {};  // rad/s or m/s
  std::vector<double> effort = {};    // Nm or N
};

// The same, looking into a payload. Reuse one object: decoding the same shape again does not allocate.
struct JointStateView {
  RosTime stamp;
  std::string_view frame_id;
  std::vector<std::string_view> name;
  DoubleSequenceView position;
  DoubleSequenceView velocity;
  DoubleSequenceView effort;
};

// geometry_msgs/TransformStamped: the pose of `child_frame_id` in `header.frame_id`.
struct TransformStamped {
  Header header;
  std::string child_frame_id;
  std::array<double, 3> translation{};             // x, y, z [m]
  std::array<double, 4> rotation{0., 0., 0., 1.};  // quaternion x, y, z, w
};

struct TfMessage {
  std::vector<TransformStamped> transforms;
};

// The decoders check form only (lengths, bounds, terminated strings), not meaning: arrays may differ in length and
// values may be NaN. After a fault the message's content is unspecified. Bytes behind the message are ignored.
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, JointStateView& message);
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, JointState& message);
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, TfMessage& message);

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity.
void encode(const JointState& message, std::vector<std::byte>& out);
void encode(const TfMessage& message, std::vector<std::byte>& out);
// std_msgs/String. The text that is read is valid as long as the payload.
void encode(std::string_view text, std::vector<std::byte>& out);
[[nodiscard]] CdrFault decode(std::span<const std::byte> payload, std::string_view& text);
// For messages that begin with a header.
void write(const Header& header, CdrWriter& out);

}  // namespace cellmirror::dds
