// What the colours of the picture mean: only of what is in it.
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/force_arrows.hpp"
#include "rt_core/scene/scene_builder.hpp"
#include "rt_core/scene/tissue.hpp"

namespace cellmirror::scene {

// None where it is switched off (SET_MODE LEGEND) and in full screen (STDP FULL).
void write_legend(const SceneInput& input, const ForceArrows& arrows, const TissueMarks& tissue, Scene& scene);

}  // namespace cellmirror::scene
