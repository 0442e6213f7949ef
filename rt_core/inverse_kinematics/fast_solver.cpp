#include "rt_core/inverse_kinematics/fast_solver.hpp"

#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/inverse_kinematics/request.hpp"
#include "rt_core/inverse_kinematics/search.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

// The first solution that is met counts, from the present posture or else from postures all over the ranges: the step
// with restarts, for comparison and for simple uses.
class FastSolver final : public Solver {
 public:
  FastSolver(const kinematics::Chain& chain, const Clock& clock) : chain_(chain), clock_(clock), spread_(chain_) {}

  [[nodiscard]] Result<Answer> solve(const Request& asked) override {
    constexpr std::size_t kMostFastStarts = 1000;
    constexpr std::size_t kFastStartsWithoutNews = 80;
    constexpr int kIterations = 40;
    const Result<Request> good = checked(asked, chain_);
    if (!good) return std::unexpected(good.error());
    Search search(chain_, *good, clock_);
    (void)search.descend(good->present, kIterations, FoundBy::fast);
    std::size_t without_news = 0;
    for (std::size_t start = 0; start < kMostFastStarts && search.found() < good->max_solutions; ++start) {
      if (search.out_of_time() || (search.found() > 0 && without_news >= kFastStartsWithoutNews)) break;
      const std::size_t before = search.found();
      (void)search.descend(spread_.at(start), kIterations, FoundBy::fast);
      without_news = search.found() > before ? 0 : without_news + 1;
    }
    if (good->max_solutions == 1) search.settle_best();
    return search.finish();
  }

 private:
  kinematics::Chain chain_;
  const Clock& clock_;
  PostureSpread spread_;
};

}  // namespace

std::unique_ptr<Solver> make_fast_solver(const kinematics::Chain& chain, const Clock& clock) {
  return std::make_unique<FastSolver>(chain, clock);
}

}  // namespace cellmirror::inverse_kinematics
