// Inverse kinematics for all threads but the tick: three methods behind one interface.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/kinematics/task.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::inverse_kinematics {

enum class Method : std::uint8_t {
  fast,   // the damped, box-constrained steps that the tick uses, from the present posture, with restarts
  ipopt,  // a nonlinear program
  automatic,
};
// Which routine found a solution.
enum class FoundBy : std::uint8_t { nobody, closed_form, seed_table, fast, ipopt };
[[nodiscard]] std::string_view name_of(Method method);   // "fast", "ipopt", "auto"
[[nodiscard]] std::string_view name_of(FoundBy method);  // "none", "closed-form", "seed-table", "fast", "ipopt"

struct Request {
  Pose X_BG = Pose::Identity();  // the target in the base of the chain
  kinematics::Task task;
  JointValues present{};                       // rad or m: where the search starts, and what "nearest" means
  double tolerance = 1e-5;                     // of each component of the error twist: m, rad
  std::chrono::microseconds time_limit{5000};  // kept to within one start (some 10 us), for `ipopt` one factorisation
  std::size_t max_solutions = 1;               // more than 1: several different postures on request
};

struct Solution {
  JointValues q{};                                      // within the limits, always
  kinematics::Twist error = kinematics::Twist::Zero();  // task_error() at q
  FoundBy by = FoundBy::nobody;
};

struct Answer {
  bool solved = false;              // solutions[0] meets every required component within the tolerance and the limits
  std::vector<Solution> solutions;  // nearest to the present posture first; not solved: one, the nearest reachable pose
  bool timed_out = false;           // the time limit ended the search
  int iterations = 0;               // of all searches together
};

// One chain; one thread at a time. Answers are a function of the chain and the request alone as long as the time limit
// does not end the search.
class Solver {
 public:
  virtual ~Solver() = default;
  // Refused: a target that is not finite or no rotation, a present posture that is not finite, a tolerance or time that
  // is not positive. A present posture beyond the limits is clamped. Real-time class: worker threads only.
  [[nodiscard]] virtual Result<Answer> solve(const Request& request) = 0;
};

// `automatic` builds its table of seeds here (some 20 ms); share a solver rather than create another. `clock`, for the
// time limits of requests, outlives the solver; one that stands still never ends a search, which counts of starts
// bound, too.
[[nodiscard]] std::unique_ptr<Solver> make_solver(Method method, const kinematics::Chain& chain, const Clock& clock);

}  // namespace cellmirror::inverse_kinematics
