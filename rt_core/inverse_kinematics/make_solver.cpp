#include "rt_core/inverse_kinematics/fast_solver.hpp"

namespace cellmirror::inverse_kinematics {

std::unique_ptr<Solver> make_solver(Method /*method*/, const kinematics::Chain& chain) {
  return make_fast_solver(chain);
}

}  // namespace cellmirror::inverse_kinematics
