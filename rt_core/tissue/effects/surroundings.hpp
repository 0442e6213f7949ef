// What the instruments' actions and the effects change beside the tissue itself: smoke, fog on the lens, blood lost.
#pragma once

#include <algorithm>
#include <array>

#include "rt_core/ports/tissue_settings.hpp"

namespace cellmirror::tissue {

struct Surroundings {
  std::array<bool, kTissueEffects> effects{};  // settings: a reset leaves them
  int suction = -1;                            // slot of the instrument; -1: none
  int irrigation = -1;
  double smoke = 0;     // 0 to 1
  double lens_fog = 0;  // 0 to 1
  double blood_loss_m3 = 0;

  [[nodiscard]] bool on(TissueEffect effect) const { return effects[static_cast<std::size_t>(effect)]; }
  // Smoke thins out and settles on the lens.
  void step(double dt) {
    lens_fog = std::min(1.0, lens_fog + 0.05 * smoke * dt);
    smoke *= 1.0 - 0.05 * dt;
    if (smoke < 1e-4) smoke = 0;
  }
  void reset() {
    smoke = 0;
    lens_fog = 0;
    blood_loss_m3 = 0;
  }
};

}  // namespace cellmirror::tissue
