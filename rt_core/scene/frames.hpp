// Coordinate systems in the picture: workframes (SET_MODE WFRM_display, TAG_DRAWLEN), TCP and ZP frame of the active
// robot (TCP_DRAW, ZPF_DRAW).
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// The active robot; null: none, or not in memory.
[[nodiscard]] const CompiledRobot* active_robot(const SceneInput& input);
// With the origin's bare name. Workframes of cameras and sensors are workframes too; hidden ones are left out.
void draw_frames(const SceneInput& input, Scene& scene);

}  // namespace cellmirror::scene
