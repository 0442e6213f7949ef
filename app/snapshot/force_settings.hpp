// The settings of SCRIPT for forces: arrows, limits, and a test value in place of the computed one.
#pragma once

#include <array>
#include <optional>

#include "rt_core/ports/force_state.hpp"

namespace cellmirror::app {

struct ForceSettings {
  ForceArrowSettings arrows;                  // SET_FORCE_ARROW, SET_FRC_ARR_SPECIAL
  ForceLimits limits;                         // SET_TORQUE_LIMIT
  std::optional<std::array<double, 4>> test;  // SET_EXT_TCP_TEST on: force x, y, z [N], torque about z [Nm]
};

}  // namespace cellmirror::app
