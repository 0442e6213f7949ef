// visualization_msgs/MarkerArray of ROS 2's common_interfaces, and its bytes. Pure; see ros2_messages.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kMarkerArrayType = "visualization_msgs::msg::dds_::MarkerArray_";

enum class MarkerType : std::int32_t { arrow = 0, line_list = 5, sphere_list = 7, triangle_list = 11 };
enum class MarkerAction : std::int32_t { add = 0, remove = 2 };  // `add` replaces one of the same name and number, too

using MarkerPoint = std::array<double, 3>;  // m
using MarkerColour = std::array<float, 4>;  // red, green, blue, alpha; 0..1

// Textures, meshes and texts, which the type also has, are written empty.
struct Marker {
  Header header = {};
  std::string ns = {};  // name space; with `id` what a marker is called
  std::int32_t id = 0;
  MarkerType type = MarkerType::line_list;
  MarkerAction action = MarkerAction::add;
  MarkerPoint position = {};
  std::array<double, 4> orientation = {0, 0, 0, 1};  // quaternion x, y, z, w
  MarkerPoint scale = {1, 1, 1};  // line_list: x is the width; sphere_list: the diameters; triangle_list: 1, 1, 1;
  // arrow from the first point to the second: diameters of shaft and head
  MarkerColour colour = {1, 1, 1, 1};
  std::int64_t lifetime_ns = 0;  // after which a viewer removes it; 0: never
  std::vector<MarkerPoint> points = {};
  std::vector<MarkerColour> colours = {};  // none, or one a point
};

struct MarkerArray {
  std::vector<Marker> markers;
};

// Little endian, with encapsulation header. `out` is overwritten and keeps its capacity. A lifetime is at most what 32
// bits of seconds hold.
void encode(const MarkerArray& message, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
