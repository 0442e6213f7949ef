// The viewing pyramids of cameras (CAM_VIEW_PYRAMID).
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// Of a picture of 4 to 3, up to the viewing distance; a camera that tracks has a dashed line to what it tracks. Not
// shown in panes of the camera itself.
void draw_pyramids(const SceneInput& input, Scene& scene);

}  // namespace cellmirror::scene
