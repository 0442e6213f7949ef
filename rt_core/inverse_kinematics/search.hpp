// One request while it is worked on: descents from starts, what they found, and the time. Internal to the folder.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/fast_step.hpp"

namespace cellmirror::inverse_kinematics {

// Postures closer together than this (root of the sum of squared joint differences, rad and m) count as one.
inline constexpr double kDistinctPostures = 0.1;

class Search {
 public:
  // Both have to outlive the search. `request` is a checked one.
  Search(const kinematics::Chain& chain, const Request& request);

  // Steps from `start`. Whether that led to a solution; it is kept if no nearer one is at the same place.
  bool descend(const JointValues& start, int max_iterations, FoundBy by);

  // Keeps a posture that somebody found, after checking it by the plain forward kinematics and the limits.
  bool keep(const JointValues& q, FoundBy by);

  [[nodiscard]] std::size_t found() const { return found_.size(); }
  [[nodiscard]] double nearest_distance() const { return nearest_distance_; }
  // Looks at the clock; once it is true it stays true.
  [[nodiscard]] bool out_of_time();

  [[nodiscard]] Answer finish();

 private:
  struct Found {
    Solution solution;
    double distance = 0;
  };

  const kinematics::Chain& chain_;
  const Request& request_;
  std::chrono::steady_clock::time_point deadline_;
  bool timed_out_ = false;
  int iterations_ = 0;
  double nearest_distance_;
  std::vector<Found> found_;
  Solution closest_;  // of those that do not meet the target
  double least_miss_;
};

}  // namespace cellmirror::inverse_kinematics
