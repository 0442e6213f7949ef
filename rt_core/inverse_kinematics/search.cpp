#include "rt_core/inverse_kinematics/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/kinematics/null_space.hpp"
#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameAttempt = 1e-3;  // rad: attempted orientations this close are equally good

JointValues wished_posture(const kinematics::Chain& chain, const Request& request) {
  JointValues wished = request.present;
  if (request.task.secondary == kinematics::Secondary::nearest_present) return wished;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (kinematics::bends(chain, request.task, i)) wished[i] = 0;
  }
  return wished;
}

}  // namespace

Search::Search(const kinematics::Chain& chain, const Request& request, const Clock& clock)
    : chain_(chain),
      request_(request),
      wished_(wished_posture(chain, request)),
      clock_(clock),
      deadline_(clock.now() + request.time_limit),
      least_miss_(kInfinity) {
  found_.reserve(8);
}

bool Search::out_of_time() {
  // A busy machine must not end the search after one start. This much work (some 0.5 ms) is always done, unless the
  // time limit is very short.
  constexpr std::size_t kLeastStarts = 64;
  constexpr std::chrono::milliseconds kShortLimit(2);
  if (starts_ < kLeastStarts && request_.time_limit >= kShortLimit) return false;
  timed_out_ = timed_out_ || clock_.now() >= deadline_;
  return timed_out_;
}

double Search::best_attempt() const {
  double best = kInfinity;
  for (const Found& found : found_) best = std::min(best, found.attempt);
  return best;
}

double Search::nearest_distance() const {
  double nearest = kInfinity;
  for (const Found& found : found_) nearest = std::min(nearest, found.distance);
  return nearest;
}

bool Search::better(const Found& a, const Found& b) {
  if (std::abs(a.attempt - b.attempt) > kSameAttempt) return a.attempt < b.attempt;
  return a.distance < b.distance;
}

bool Search::descend(const JointValues& start, int max_iterations, FoundBy by) {
  ++starts_;
  JointValues q = start;
  const kinematics::FastResult result =
      kinematics::fast_solve(chain_, request_.task, request_.X_BG, {q.data(), chain_.variable_count()},
                             {.tolerance = request_.tolerance, .max_iterations = max_iterations});
  iterations_ += result.iterations;
  if (result.solved) return keep(q, by);
  miss(q, result.error);
  return false;
}

void Search::miss(const JointValues& q, const kinematics::Twist& error) {
  if (!found_.empty()) return;
  // Metres weigh as in the search, so that a long arm's centimetres do not hide a wrong direction. What is only
  // attempted comes last.
  const double length = kinematics::unit_of_length(chain_);
  const double attempted = request_.task.orientation_required ? 1.0 : 1e-6;
  const double miss = error.head<3>().squaredNorm() / (length * length) + attempted * error.tail<3>().squaredNorm();
  if (!(miss < least_miss_)) return;
  least_miss_ = miss;
  closest_ = {.q = q, .error = error};
}

bool Search::keep(const JointValues& q, FoundBy by) {
  Found found;
  found.solution.q = nearest_turns(chain_, q, wished_);
  const std::span<const double> values(found.solution.q.data(), chain_.variable_count());
  found.solution.error = kinematics::task_error(request_.task, kinematics::forward(chain_, values), request_.X_BG);
  found.solution.by = by;
  if (!chain_.within_limits(values) || !kinematics::meets(request_.task, found.solution.error, request_.tolerance)) {
    return false;
  }
  found.distance = distance(chain_, found.solution.q, wished_);
  if (!request_.task.orientation_required) found.attempt = found.solution.error.tail<3>().norm();
  const auto counts_as_it = [&](const Found& other) {
    return distance(chain_, other.solution.q, found.solution.q) < kDistinctPostures;
  };
  const bool known = std::any_of(found_.begin(), found_.end(),
                                 [&](const Found& other) { return counts_as_it(other) && !better(found, other); });
  if (known) return true;
  std::erase_if(found_, counts_as_it);
  found_.push_back(found);
  return true;
}

void Search::settle_best() {
  if (found_.empty() || !kinematics::has_choice(chain_, request_.task)) return;
  Found& best = *std::min_element(found_.begin(), found_.end(), better);
  JointValues q = best.solution.q;
  const std::size_t n = chain_.variable_count();
  const int steps = kinematics::settle(chain_, request_.task, request_.X_BG, {wished_.data(), n}, {q.data(), n},
                                       {.tolerance = request_.tolerance});
  iterations_ += steps;
  if (steps > 0) (void)keep(q, best.solution.by);
}

// Keeps the best and then always the one that is farthest from all kept so far: a redundant arm has any number.
void Search::spread_out(std::size_t wanted) {
  std::vector<double> gap(found_.size(), kInfinity);
  for (std::size_t kept = 1; kept < wanted; ++kept) {
    std::size_t farthest = kept;
    for (std::size_t i = kept; i < found_.size(); ++i) {
      gap[i] = std::min(gap[i], distance(chain_, found_[i].solution.q, found_[kept - 1].solution.q));
      if (gap[i] > gap[farthest]) farthest = i;
    }
    std::swap(found_[kept], found_[farthest]);
    std::swap(gap[kept], gap[farthest]);
  }
  found_.resize(wanted);
  std::sort(found_.begin(), found_.end(), better);
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
  std::sort(found_.begin(), found_.end(), better);
  const std::size_t wanted = std::min(found_.size(), request_.max_solutions);
  const bool any_number = kinematics::has_choice(chain_, request_.task);
  if (wanted > 1 && wanted < found_.size() && any_number) spread_out(wanted);
  answer.solutions.reserve(wanted);
  for (std::size_t i = 0; i < wanted; ++i) answer.solutions.push_back(found_[i].solution);
  return answer;
}

}  // namespace cellmirror::inverse_kinematics
