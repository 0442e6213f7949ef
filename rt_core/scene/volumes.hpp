// Voxel volumes in a scene.
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// Replaces the scene's volumes: those that are visible, each at the pose of its component. One that `input` has no
// state of is drawn as its file has it.
void place_volumes(const SceneInput& input, Scene& scene);

}  // namespace cellmirror::scene
