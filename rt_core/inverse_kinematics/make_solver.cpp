#include "rt_core/inverse_kinematics/automatic_solver.hpp"
#include "rt_core/inverse_kinematics/fast_solver.hpp"
#include "rt_core/inverse_kinematics/ipopt_solver.hpp"

namespace cellmirror::inverse_kinematics {

std::unique_ptr<Solver> make_solver(Method method, const kinematics::Chain& chain, const Clock& clock) {
  if (method == Method::automatic) return make_automatic_solver(chain, clock);
  if (method == Method::ipopt) return make_ipopt_solver(chain, clock, {});
  return make_fast_solver(chain, clock);
}

}  // namespace cellmirror::inverse_kinematics
