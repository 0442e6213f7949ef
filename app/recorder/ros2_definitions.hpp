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
inline constexpr std::string_view kMarker =
    "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\n"
    "int32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\n"
    "int32 TRIANGLE_LIST=11\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
    "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
    "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\n"
    "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n"
    "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
    "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n";
inline constexpr std::string_view kMarkerArray = "visualization_msgs/Marker[] markers\n";
inline constexpr std::string_view kPose = "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n";
inline constexpr std::string_view kColour = "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n";
inline constexpr std::string_view kDuration = "int32 sec\nuint32 nanosec\n";
inline constexpr std::string_view kUvCoordinate = "float32 u\nfloat32 v\n";
inline constexpr std::string_view kMeshFile = "string filename\nuint8[] data\n";
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

inline std::string marker_array() {
  return std::string(kMarkerArray) + part("visualization_msgs/Marker", kMarker) + part("std_msgs/Header", kHeader) +
         part("builtin_interfaces/Time", kTime) + part("builtin_interfaces/Duration", kDuration) +
         part("geometry_msgs/Pose", kPose) + part("geometry_msgs/Point", kVector3) +
         part("geometry_msgs/Quaternion", kQuaternion) + part("geometry_msgs/Vector3", kVector3) +
         part("std_msgs/ColorRGBA", kColour) + part("sensor_msgs/CompressedImage", kCompressedImage) +
         part("visualization_msgs/UVCoordinate", kUvCoordinate) + part("visualization_msgs/MeshFile", kMeshFile);
}

}  // namespace ros2

}  // namespace cellmirror::app
