#include "drivers/dds/marker_messages.hpp"

#include <algorithm>
#include <limits>

namespace cellmirror::dds {

namespace {

void write_numbers(CdrWriter& out, const auto& numbers) {
  for (const auto number : numbers) out.write(number);
}

void write_duration(CdrWriter& out, std::int64_t ns) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  constexpr std::int64_t kLongest = std::numeric_limits<std::int32_t>::max() * kNsPerSecond;
  ns = std::clamp<std::int64_t>(ns, 0, kLongest);
  out.write(static_cast<std::int32_t>(ns / kNsPerSecond));
  out.write(static_cast<std::uint32_t>(ns % kNsPerSecond));
}

// What follows the points and colours in the type of ROS 2 Humble and later; all of it is empty.
void write_texture_text_and_mesh(CdrWriter& out) {
  out.write_text({});          // texture_resource
  write(Header{}, out);        // texture, a CompressedImage
  out.write_text({});          // texture.format
  out.write_count(0);          // texture.data
  out.write_count(0);          // uv_coordinates
  out.write_text({});          // text
  out.write_text({});          // mesh_resource
  out.write_text({});          // mesh_file.filename
  out.write_count(0);          // mesh_file.data
  out.write(std::uint8_t{0});  // mesh_use_embedded_materials
}

void write_marker(CdrWriter& out, const Marker& marker) {
  write(marker.header, out);
  out.write_text(marker.ns);
  out.write(marker.id);
  out.write(static_cast<std::int32_t>(marker.type));
  out.write(static_cast<std::int32_t>(marker.action));
  write_numbers(out, marker.position);
  write_numbers(out, marker.orientation);
  write_numbers(out, marker.scale);
  write_numbers(out, marker.colour);
  write_duration(out, marker.lifetime_ns);
  out.write(std::uint8_t{0});  // frame_locked
  out.write_count(marker.points.size());
  for (const MarkerPoint& point : marker.points) write_numbers(out, point);
  out.write_count(marker.colours.size());
  for (const MarkerColour& colour : marker.colours) write_numbers(out, colour);
  write_texture_text_and_mesh(out);
}

}  // namespace

void encode(const MarkerArray& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  writer.write_count(message.markers.size());
  for (const Marker& marker : message.markers) write_marker(writer, marker);
}

}  // namespace cellmirror::dds
