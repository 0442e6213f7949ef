// What a client that draws the cell itself gets beside its geometry (docs/monitor-page.md): poses and marks. Pure.
#pragma once

#include <span>
#include <string>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/cameras.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kMostMarks = 5000;        // of each kind, as in pictures
inline constexpr std::size_t kMostTracePoints = 2000;  // of all traces together, the newest
inline constexpr std::size_t kMostLabels = 500;

// Little-endian. Six counts, u32: bodies, lines, axes, cones, arrows, cameras; then
//   a body      7 f32: x y z, quaternion x y z w
//   a line      9 x 4 bytes: f32 from, to, width in pixels; u32 colour (red in the lowest byte); u32 bits: 1 dashed, 2
//   on top axes        9 f32: pose as a body's, length, 1 where emphasized a cone      9 f32: pose, half angle in rad,
//   length; u32 colour an arrow    6 f32: from, along; u32 colour; u32 1 for a torque a camera    9 f32: pose (z along
//   the optical axis, y down), vertical opening angle in rad, viewing distance
// and one byte a body: its mark in bits 0 to 3 (0 none, 1 near, 2 touching, 3 ghost), how it is drawn in bits 4 to 7
// (0 smooth, 1 flat, 2 wireframe, 3 transparent). What is not finite is sent as 0.
[[nodiscard]] std::string scene_poses(const Scene& scene, std::span<const scene::CameraNow> cameras);

// The JSON text of {"is": "marks", ...}: labels, names, traces, floor, legend, messages.
[[nodiscard]] std::string scene_marks(const Scene& scene, const CompiledCell& cell,
                                      std::span<const scene::CameraNow> cameras);

}  // namespace cellmirror::app
