// The geometry that moves with a robot, by the names under which eladyn_geo_def accepts it.
#pragma once

#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

// Done if `name` is that of a frame or joint with visible geometry that moves with a joint of the robot (its bare name
// or its dotted path), or of such a geometry. Refused with the nearest names, or some of those that there are.
[[nodiscard]] Result<void> check_effector_geometry(const CompiledCell& cell, const CompiledRobot& robot,
                                                   std::string_view name);

}  // namespace cellmirror::app
