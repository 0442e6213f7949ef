// The definitions of the ROS 2 messages that a recording has, in the form of the schema encoding "ros2msg": the
// interface, without its comments. Constants.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror::app {

namespace ros2 {

inline constexpr std::string_view kDivider =
    "================================================================================\n";
inline constexpr std::string_view kTime = "int32 sec\nuint32 nanosec\n";
inline constexpr std::string_view kHeader = "builtin_interfaces/Time stamp\nstring frame_id\n";
inline constexpr std::string_view kVector3 = "float64 x\nfloat64 y\nfloat64 z\n";
inline constexpr std::string_view kQuaternion = "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n";
inline constexpr std::string_view kTransform = "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n";
inline constexpr std::string_view kTransformStamped =
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n";
inline constexpr std::string_view kWrench = "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n";

inline constexpr std::string_view kJointState =
    "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n";
inline constexpr std::string_view kTfMessage = "geometry_msgs/TransformStamped[] transforms\n";
inline constexpr std::string_view kRange =
    "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\nfloat32 field_of_view\n"
    "float32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n";
inline constexpr std::string_view kWrenchStamped = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n";
inline constexpr std::string_view kCompressedImage = "std_msgs/Header header\nstring format\nuint8[] data\n";
inline constexpr std::string_view kLog =
    "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\nbuiltin_interfaces/Time stamp\n"
    "uint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n";

inline std::string part(std::string_view type, std::string_view definition) {
  return std::string(kDivider) + "MSG: " + std::string(type) + "\n" + std::string(definition);
}
inline std::string with_header(std::string_view definition) {
  return std::string(definition) + part("std_msgs/Header", kHeader) + part("builtin_interfaces/Time", kTime);
}

inline std::string joint_state() { return with_header(kJointState); }
inline std::string compressed_image() { return with_header(kCompressedImage); }
inline std::string range() { return with_header(kRange); }
inline std::string log() { return std::string(kLog) + part("builtin_interfaces/Time", kTime); }
inline std::string wrench_stamped() {
  return with_header(kWrenchStamped) + part("geometry_msgs/Wrench", kWrench) + part("geometry_msgs/Vector3", kVector3);
}
inline std::string tf_message() {
  return with_header(kTfMessage) + part("geometry_msgs/TransformStamped", kTransformStamped) +
         part("geometry_msgs/Transform", kTransform) + part("geometry_msgs/Vector3", kVector3) +
         part("geometry_msgs/Quaternion", kQuaternion);
}

}  // namespace ros2

}  // namespace cellmirror::app
