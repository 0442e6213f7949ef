// The cones of range sensors with their readings, and the beams of light barriers.
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// A cone reaches as far as the reading, with a line to the point on the surface; without one as far as the sensor can.
// An active sensor of which no reading came yet: its cone alone.
void draw_cones(const SceneInput& input, Scene& scene);
// A line from end to end with the name and what interrupts it; dashed where that is doubtful.
void draw_beams(const SceneInput& input, Scene& scene);

}  // namespace cellmirror::scene
