#include "rt_core/inverse_kinematics/automatic_solver.hpp"
#include "rt_core/inverse_kinematics/fast_solver.hpp"
#include "rt_core/inverse_kinematics/ipopt_solver.hpp"

namespace cellmirror::inverse_kinematics {

std::unique_ptr<Solver> make_solver(Method method, const kinematics::Chain& chain) {
  if (method == Method::automatic) return make_automatic_solver(chain);
  if (method == Method::ipopt) return make_ipopt_solver(chain);
  return make_fast_solver(chain);
}

}  // namespace cellmirror::inverse_kinematics
