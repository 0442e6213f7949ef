#include "rt_core/inverse_kinematics/fast_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/inverse_kinematics/request.hpp"
#include "rt_core/kinematics/fast_step.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

using Clock = std::chrono::steady_clock;

class FastSolver final : public Solver {
 public:
  explicit FastSolver(const kinematics::Chain& chain) : chain_(chain) {}

  [[nodiscard]] Result<Answer> solve(const Request& asked) override {
    const Result<Request> good = checked(asked, chain_);
    if (!good) return std::unexpected(good.error());
    const Request& request = *good;
    const auto deadline = Clock::now() + request.time_limit;
    Answer answer;
    Solution nearest;
    double least = std::numeric_limits<double>::infinity();
    std::mt19937_64 random(1);
    JointValues q = request.present;
    for (int start = 0; start < 1000; ++start) {
      const auto result =
          kinematics::fast_solve(chain_, request.task, request.X_BG, {q.data(), chain_.variable_count()},
                                 {.tolerance = request.tolerance, .max_iterations = 40});
      answer.iterations += result.iterations;
      if (result.solved) {
        Solution found;
        found.q = nearest_turns(chain_, q, request.present);
        const Pose X_BT = kinematics::forward(chain_, {found.q.data(), chain_.variable_count()});
        found.error = kinematics::task_error(request.task, X_BT, request.X_BG);
        found.by = FoundBy::fast;
        answer.solved = kinematics::meets(request.task, found.error, request.tolerance);
        if (answer.solved) {
          answer.solutions.push_back(found);
          return answer;
        }
      }
      if (result.error.squaredNorm() < least) {
        least = result.error.squaredNorm();
        nearest = {.q = q, .error = result.error};
      }
      if (Clock::now() > deadline) {
        answer.timed_out = true;
        break;
      }
      for (std::size_t i = 0; i < chain_.variable_count(); ++i) {
        const bool bounded = std::isfinite(chain_.lower()[i]);
        q[i] = std::uniform_real_distribution<double>(bounded ? chain_.lower()[i] : -M_PI,
                                                      bounded ? chain_.upper()[i] : M_PI)(random);
      }
    }
    answer.solutions.push_back(nearest);
    return answer;
  }

 private:
  kinematics::Chain chain_;
};

}  // namespace

std::unique_ptr<Solver> make_fast_solver(const kinematics::Chain& chain) { return std::make_unique<FastSolver>(chain); }

}  // namespace cellmirror::inverse_kinematics
