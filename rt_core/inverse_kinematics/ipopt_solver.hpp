// Inverse kinematics as a nonlinear program with bounds, solved by Ipopt (docs/decisions/0008-ipopt-in-parallel.md).
#pragma once

#include <cstdint>
#include <memory>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::inverse_kinematics {

// For comparisons; the default is what was measured best.
struct IpoptSettings {
  // mumps: Ipopt's own; one search at a time in the whole process, whatever the number of solvers.
  enum class LinearSolver : std::uint8_t { dense, mumps };
  // Far from the target by_distance is Gauss-Newton, near it exact.
  enum class Hessian : std::uint8_t { by_distance, exact, gauss_newton };
  LinearSolver linear_solver = LinearSolver::dense;
  Hessian hessian = Hessian::by_distance;
};

// From the present posture first, then from others that are the same for every request. Redundancy is resolved by the
// task's secondary objective: a local minimum of it, from the posture that was found. A task that is only attempted in
// its orientation is met in what it requires, then turned as near as that allows.
[[nodiscard]] std::unique_ptr<Solver> make_ipopt_solver(const kinematics::Chain& chain, const Clock& clock,
                                                        const IpoptSettings& settings);

}  // namespace cellmirror::inverse_kinematics
