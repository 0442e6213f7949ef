// Traces of TCPs in the picture (SET_MODE SMEAR): a curve for each, and with TCP_DRAW the frames of the TCP along it.
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// Those of robots that the cell still has.
void draw_traces(const SceneInput& input, Scene& scene);

}  // namespace cellmirror::scene
