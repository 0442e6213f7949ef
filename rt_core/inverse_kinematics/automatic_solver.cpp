#include "rt_core/inverse_kinematics/automatic_solver.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <span>

#include "rt_core/inverse_kinematics/closed_form.hpp"
#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/inverse_kinematics/request.hpp"
#include "rt_core/inverse_kinematics/search.hpp"
#include "rt_core/inverse_kinematics/seed_table.hpp"
#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

using kinematics::OrientationTask;
using kinematics::Task;

// How much is tried. The first numbers keep the mean time low and the next ones its tail, the last bounds the time that
// a target takes that cannot be reached; measured on all arms of the benchmark. All are counts, so that answers repeat.
constexpr int kIterationsNear = 12;  // from the present posture when the target is near
constexpr int kIterationsFromSeed = 20;
constexpr int kIterationsFromSpread = 40;
constexpr std::size_t kFirstSeeds = 16;
constexpr std::size_t kMoreSeeds = SeedTable::kMostSeeds;  // when none of the first led to a solution
constexpr std::size_t kLooks = 2;                          // starts from seeds of which the nearest solution is taken
constexpr double kNearness = 0.02;                         // of a squared joint distance beside a squared pose distance
constexpr std::size_t kAttempts = 6;            // starts for an orientation that is only attempted, or an even bend
constexpr std::size_t kMostStarts = 300;        // all over the ranges, until a target counts as out of reach
constexpr std::size_t kStartsOutOfReach = 12;   // when it certainly is: for the nearest reachable pose
constexpr std::size_t kStartsWithoutNews = 80;  // if several solutions are requested

bool whole_pose(const Task& task) { return task.position_axes == 0b111 && task.orientation == OrientationTask::full; }

class AutomaticSolver final : public Solver {
 public:
  AutomaticSolver(const kinematics::Chain& chain, const Clock& clock)
      : chain_(chain),
        clock_(clock),
        reach_(kinematics::reach_bound(chain)),
        unit_(kinematics::unit_of_length(chain)),
        closed_form_(ClosedForm::analyse(chain)),
        table_(chain_),
        spread_(chain_) {}

  [[nodiscard]] Result<Answer> solve(const Request& asked) override {
    const Result<Request> good = checked(asked, chain_);
    if (!good) return std::unexpected(good.error());
    const Request& request = *good;
    Search search(chain_, request, clock_);
    if (whole_pose(request.task) && request.task.orientation_required) {
      from_closed_form(search, request);
      if (enough(search, request)) return search.finish();
    }
    if (from_present(search, request)) return search.finish();
    if (whole_pose(request.task)) {
      from_table<kFirstSeeds>(search, request, 0);
      if (search.found() == 0 && !search.out_of_time()) from_table<kMoreSeeds>(search, request, kFirstSeeds);
    }
    from_spread(search, request);
    if (request.max_solutions == 1) search.settle_best();
    return search.finish();
  }

 private:
  // One solution is requested and the nearest of all is found, or all exist.
  [[nodiscard]] bool enough(const Search& search, const Request& request) const {
    return search.found() > 0 && (request.max_solutions == 1 || closed_form_->exact());
  }

  void from_closed_form(Search& search, const Request& request) const {
    if (!closed_form_) return;
    struct Candidate {
      JointValues q{};
      double distance = 0;
    };
    std::array<JointValues, kMaxClosedForms> postures;
    std::array<Candidate, kMaxClosedForms> candidates;
    const std::size_t count = closed_form_->solve(request.X_BG, postures, request.present);
    for (std::size_t i = 0; i < count; ++i) {
      candidates[i].q = nearest_turns(chain_, postures[i], request.present);
      candidates[i].distance = distance(chain_, candidates[i].q, request.present);
    }
    std::sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    constexpr int kPolish = 6;
    for (std::size_t i = 0; i < count; ++i) {
      const JointValues& q = candidates[i].q;
      const std::span<const double> values(q.data(), chain_.variable_count());
      if (closed_form_->exact() && !chain_.within_limits(values)) continue;
      const bool kept = search.keep(q, FoundBy::closed_form) || search.descend(q, kPolish, FoundBy::closed_form);
      if (kept && request.max_solutions == 1) return;
    }
  }

  // A target near the present pose has its nearest solution downhill from here. Whether that is the answer.
  bool from_present(Search& search, const Request& request) const {
    constexpr double kNearPose = 0.5;     // rad, units of length
    constexpr double kNearPosture = 1.0;  // a solution farther away may not be the nearest
    const std::span<const double> values(request.present.data(), chain_.variable_count());
    const kinematics::Twist error =
        kinematics::task_error(request.task, kinematics::forward(chain_, values), request.X_BG);
    const double away = error.head<3>().norm() / unit_ + error.tail<3>().norm();
    const bool whole = whole_pose(request.task);
    if (whole && away > kNearPose) return false;
    if (!search.descend(request.present, whole ? kIterationsNear : kIterationsFromSpread, FoundBy::fast)) return false;
    const bool one_is_enough =
        request.task.orientation_required && request.task.secondary == kinematics::Secondary::nearest_present;
    if (request.max_solutions > 1 || !one_is_enough) return false;
    if (search.nearest_distance() > kNearPosture) return false;
    search.settle_best();
    return true;
  }

  // From the nearest entries, but for the first `done` that were tried before.
  template <std::size_t kMost>
  void from_table(Search& search, const Request& request, std::size_t done) const {
    std::array<Seed, kMost> seeds;
    const std::size_t count = table_.find(request.X_BG, search.wished(), seeds);
    std::array<std::size_t, kMost> order{};
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [&](std::size_t i) { return seeds[i].pose_distance_sq + kNearness * seeds[i].joint_distance_sq; };
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(done), order.begin() + static_cast<std::ptrdiff_t>(count),
              [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    const bool several = request.max_solutions > 1;
    for (std::size_t i = done; i < count; ++i) {
      if (!several && i >= kLooks && search.found() > 0) return;
      (void)search.descend(seeds[order[i]].q, kIterationsFromSeed, FoundBy::seed_table);
      if (search.out_of_time()) return;
    }
  }

  // Starts all over the ranges: as many as the request needs.
  void from_spread(Search& search, const Request& request) const {
    const Eigen::Vector3d first = chain_.joints().front().X_PJ.translation();
    const bool out_of_reach =
        request.task.position_axes == 0b111 && (request.X_BG.translation() - first).norm() > reach_;
    const std::size_t most = out_of_reach ? kStartsOutOfReach : kMostStarts;
    const bool several = request.max_solutions > 1;
    const bool attempted = !request.task.orientation_required;
    const bool bends = request.task.secondary == kinematics::Secondary::even_bend;
    std::size_t without_news = 0;
    for (std::size_t start = 0; start < most && !search.out_of_time(); ++start) {
      const std::size_t found = search.found();
      if (found > 0) {
        if (several && (without_news >= kStartsWithoutNews || found >= 4 * request.max_solutions)) return;
        const bool good_enough = !bends && (!attempted || search.best_attempt() <= request.tolerance);
        if (!several && (good_enough || start >= kAttempts)) return;
      }
      (void)search.descend(spread_.at(start), kIterationsFromSpread, FoundBy::fast);
      without_news = search.found() > found ? 0 : without_news + 1;
    }
  }

  kinematics::Chain chain_;
  const Clock& clock_;
  double reach_;
  double unit_;
  std::optional<ClosedForm> closed_form_;
  SeedTable table_;
  PostureSpread spread_;
};

}  // namespace

std::unique_ptr<Solver> make_automatic_solver(const kinematics::Chain& chain, const Clock& clock) {
  return std::make_unique<AutomaticSolver>(chain, clock);
}

}  // namespace cellmirror::inverse_kinematics
