#include "app/render/scene_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "app/render/message_bytes.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

namespace {

template <class List>
auto first_of(const List& list, std::size_t most) {
  return std::span(list).first(std::min(list.size(), most));
}

std::uint8_t state_of(const SceneBody& body) {
  const auto drawn = [&]() -> std::uint8_t {
    switch (body.mode) {
      case DrawMode::flat:
        return 1;
      case DrawMode::wireframe:
        return 2;
      case DrawMode::transparent:
        return 3;
      case DrawMode::gouraud:
        break;
    }
    return 0;
  }();
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(body.mark) | drawn << 4U);
}

std::string_view word_of(Mark mark) {
  switch (mark) {
    case Mark::near:
      return "near";
    case Mark::touching:
      return "touching";
    case Mark::ghost:
      return "ghost";
    case Mark::none:
      break;
  }
  return "";
}

void write_point(JsonWriter& out, const Eigen::Vector3d& point) {
  constexpr int kDecimals = 4;  // 0.1 mm
  out.begin_array();
  for (int i = 0; i < 3; ++i) out.fixed(std::isfinite(point[i]) ? point[i] : 0.0, kDecimals);
  out.end_array();
}

void write_colour(JsonWriter& out, const Colour& colour) {
  out.key("rgba").begin_array();
  for (const float value : colour) out.fixed(std::isfinite(value) ? static_cast<double>(value) : 1.0, 3);
  out.end_array();
}

void write_traces(JsonWriter& out, const Scene& scene) {
  constexpr int kDecimals = 4;
  std::size_t left = kMostTracePoints;
  out.key("traces").begin_array();
  for (const SceneTrace& trace : first_of(scene.traces, kMostMarks)) {
    const std::size_t count = std::min(trace.points.size(), left);
    left -= count;
    if (count < 2) continue;
    out.begin_object();
    write_colour(out, trace.rgba);
    out.key("points_m").begin_array();
    for (const Eigen::Vector3f& point : std::span(trace.points).last(count)) {
      for (int i = 0; i < 3; ++i) out.fixed(static_cast<double>(point[i]), kDecimals);
    }
    out.end_array().end_object();
  }
  out.end_array();
}

void write_floor(JsonWriter& out, const Scene& scene) {
  out.key("floor").begin_object();
  out.member("shown", scene.modes.test(static_cast<std::size_t>(DisplayMode::floor))).member("z_m", scene.floor_z_m);
  for (const auto& [name, corner] : {std::pair("low_m", scene.floor_low), std::pair("high_m", scene.floor_high)}) {
    out.key(name).begin_array().value(corner.x()).value(corner.y()).end_array();
  }
  out.end_object();
}

}  // namespace

std::string scene_poses(const Scene& scene, std::span<const scene::CameraNow> cameras) {
  const auto lines = first_of(scene.lines, kMostMarks);
  const auto axes = first_of(scene.axes, kMostMarks);
  const auto cones = first_of(scene.cones, kMostMarks);
  const auto arrows = first_of(scene.arrows, kMostMarks);
  MessageBytes out;
  out.reserve(24 + 29 * scene.bodies.size() + 36 * (lines.size() + axes.size()) + 40 * cones.size() +
              32 * arrows.size() + 36 * cameras.size());
  for (const std::size_t count :
       {scene.bodies.size(), lines.size(), axes.size(), cones.size(), arrows.size(), cameras.size()}) {
    out.put(static_cast<std::uint32_t>(count));
  }
  for (const SceneBody& body : scene.bodies) out.put(body.X_WG);
  for (const SceneLine& line : lines) {
    out.put(line.from);
    out.put(line.to);
    out.put(static_cast<double>(line.width_px));
    out.put(line.rgba);
    out.put((line.dashed ? 1U : 0U) | (line.on_top ? 2U : 0U));
  }
  for (const SceneAxes& frame : axes) {
    out.put(frame.X_WF);
    out.put(frame.length_m);
    out.put(frame.emphasized ? 1.0 : 0.0);
  }
  for (const SceneCone& cone : cones) {
    out.put(cone.X_WS);
    out.put(cone.half_angle_rad);
    out.put(cone.length_m);
    out.put(cone.rgba);
  }
  for (const SceneArrow& arrow : arrows) {
    out.put(arrow.from);
    out.put(arrow.along);
    out.put(arrow.rgba);
    out.put(arrow.torque ? 1U : 0U);
  }
  for (const scene::CameraNow& camera : cameras) {
    out.put(camera.X_WC);
    out.put(camera.fovy_rad);
    out.put(camera.focal_distance_m);
  }
  for (const SceneBody& body : scene.bodies) out.put(state_of(body));
  return out.take();
}

std::string scene_marks(const Scene& scene, const CompiledCell& cell, std::span<const scene::CameraNow> cameras) {
  JsonWriter out(6);
  out.begin_object().member("is", "marks").key("labels").begin_array();
  for (const SceneLabel& label : first_of(scene.labels, kMostLabels)) {
    out.begin_object().key("at_m");
    write_point(out, label.at);
    out.member("text", std::string_view(label.text)).member("mark", word_of(label.mark)).end_object();
  }
  out.end_array().key("axes").begin_array();
  for (const SceneAxes& frame : first_of(scene.axes, kMostMarks)) out.value(std::string_view(frame.name));
  out.end_array().key("cameras").begin_array();
  for (const scene::CameraNow& camera : cameras) out.value(std::string_view(cell.cameras[camera.camera].name));
  out.end_array();
  write_traces(out, scene);
  write_floor(out, scene);
  out.key("legend").begin_array();
  for (const LegendEntry& entry : scene.legend) {
    out.begin_object().member("text", std::string_view(entry.text));
    write_colour(out, entry.rgba);
    out.end_object();
  }
  out.end_array().member("tissue", scene.tissue != nullptr).member("volumes", scene.volumes.size());
  return out.end_object().take();
}

}  // namespace cellmirror::app
