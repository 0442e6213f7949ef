#include "rt_core/scene/cones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/paths.hpp"
#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

constexpr float kBeamWidth = 2.5F;

std::string reading_text(const RangeReading& reading) {
  std::string text = reading.id;
  if (!reading.distance_m)
    text += " > " + distance_text(reading.range_m);
  else
    text += " " + distance_text(*reading.distance_m);
  if (reading.in_blind_zone) text += ", blind zone";
  if (reading.doubtful) text += ", doubtful";
  return text;
}

std::string barrier_text(const BarrierReading& barrier) {
  std::string text = barrier.name;
  if (barrier.interrupted) text += " interrupted";
  const std::string& object = barrier.short_object.empty() ? barrier.object : barrier.short_object;
  if (!object.empty()) text += ": " + object;
  if (barrier.doubtful) text += ", doubtful";
  return text;
}

void draw_reading(const RangeReading& reading, Scene& scene) {
  const double length = reading.distance_m.value_or(reading.range_m);
  scene.cones.push_back({reading.X_WS, reading.half_angle_rad, length, palette::kRange});
  const Eigen::Vector3d apex = reading.X_WS.translation();
  if (reading.distance_m) {
    SceneLine line;
    line.from = apex;
    line.to = reading.point_m;
    line.rgba = palette::opaque(palette::kRange);
    line.dashed = reading.doubtful;
    scene.lines.push_back(line);
  }
  const Eigen::Vector3d middle = apex + 0.5 * length * reading.X_WS.linear().col(2);
  scene.labels.push_back({middle, reading_text(reading), Mark::none});
}

}  // namespace

void draw_cones(const SceneInput& input, Scene& scene) {
  const CompiledCell& cell = *input.cell;
  for (const RangeReading& reading : input.ranges) draw_reading(reading, scene);
  for (const CompiledSensor& sensor : cell.sensors) {
    if (!sensor.sensor.active || cell.visible[static_cast<std::size_t>(sensor.node)] == 0) continue;
    const bool read = std::ranges::any_of(
        input.ranges, [&](const RangeReading& reading) { return names_node(cell, reading.path, sensor.node); });
    if (read) continue;
    scene.cones.push_back({input.poses->X_WN[static_cast<std::size_t>(sensor.node)], sensor.sensor.half_angle_rad,
                           sensor.sensor.range_m, palette::kRange});
  }
}

void draw_beams(const SceneInput& input, Scene& scene) {
  for (const BarrierReading& barrier : input.barriers) {
    if (!barrier.placed) continue;
    SceneLine beam;
    beam.from = barrier.from;
    beam.to = barrier.to;
    beam.rgba = barrier.interrupted ? palette::kBeamInterrupted : palette::kBeam;
    beam.width_px = kBeamWidth;
    beam.dashed = barrier.doubtful;
    scene.lines.push_back(beam);
    scene.labels.push_back({0.5 * (barrier.from + barrier.to), barrier_text(barrier), Mark::none});
  }
}

}  // namespace cellmirror::scene
