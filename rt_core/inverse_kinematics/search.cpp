#include "rt_core/inverse_kinematics/search.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}  // namespace

Search::Search(const kinematics::Chain& chain, const Request& request)
    : chain_(chain),
      request_(request),
      deadline_(std::chrono::steady_clock::now() + request.time_limit),
      nearest_distance_(kInfinity),
      least_miss_(kInfinity) {}

bool Search::out_of_time() {
  timed_out_ = timed_out_ || std::chrono::steady_clock::now() >= deadline_;
  return timed_out_;
}

bool Search::descend(const JointValues& start, int max_iterations, FoundBy by) {
  JointValues q = start;
  const kinematics::FastResult result =
      kinematics::fast_solve(chain_, request_.task, request_.X_BG, {q.data(), chain_.variable_count()},
                             {.tolerance = request_.tolerance, .max_iterations = max_iterations});
  iterations_ += result.iterations;
  if (result.solved) return keep(q, by);
  // Metres weigh as in the search, so that a long arm's centimetres do not hide a wrong direction.
  const double length = kinematics::unit_of_length(chain_);
  const double miss = result.error.head<3>().squaredNorm() / (length * length) + result.error.tail<3>().squaredNorm();
  if (miss < least_miss_) {
    least_miss_ = miss;
    closest_ = {.q = q, .error = result.error};
  }
  return false;
}

bool Search::keep(const JointValues& q, FoundBy by) {
  Found found;
  found.solution.q = nearest_turns(chain_, q, request_.present);
  const std::span<const double> values(found.solution.q.data(), chain_.variable_count());
  found.solution.error = kinematics::task_error(request_.task, kinematics::forward(chain_, values), request_.X_BG);
  found.solution.by = by;
  if (!chain_.within_limits(values) || !kinematics::meets(request_.task, found.solution.error, request_.tolerance)) {
    return false;
  }
  found.distance = distance(chain_, found.solution.q, request_.present);
  nearest_distance_ = std::min(nearest_distance_, found.distance);
  for (Found& other : found_) {
    if (distance(chain_, other.solution.q, found.solution.q) >= kDistinctPostures) continue;
    if (found.distance < other.distance) other = found;
    return true;
  }
  found_.push_back(found);
  return true;
}

Answer Search::finish() {
  Answer answer;
  answer.iterations = iterations_;
  answer.timed_out = timed_out_;
  answer.solved = !found_.empty();
  if (!answer.solved) {
    answer.solutions.push_back(closest_);
    return answer;
  }
  std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.distance < b.distance; });
  const std::size_t wanted = std::min(found_.size(), request_.max_solutions);
  answer.solutions.reserve(wanted);
  for (std::size_t i = 0; i < wanted; ++i) answer.solutions.push_back(found_[i].solution);
  return answer;
}

}  // namespace cellmirror::inverse_kinematics
