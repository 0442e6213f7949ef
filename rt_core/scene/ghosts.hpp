// Mirrored robots whose data are not fresh: drawn as ghosts, with the age of what is shown.
#pragma once

#include <span>
#include <vector>

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/bodies.hpp"
#include "rt_core/scene/robot_parts.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// Robots that are mirrored and of which nothing fresh is known.
[[nodiscard]] RobotSet ghosts_of(std::span<const RobotCondition> robots);

// Marks the bodies whose place follows from old data, whatever carries them, and labels each such robot.
void mark_ghosts(const CompiledCell& cell, std::span<const RobotCondition> robots, const Bodies& bodies,
                 const RobotParts& parts, Scene& scene);

}  // namespace cellmirror::scene
