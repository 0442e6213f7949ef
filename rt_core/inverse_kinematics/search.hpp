// One request while it is worked on: descents from starts, what they found, and the time. Internal to the folder.
#pragma once

#include <cstddef>
#include <vector>

#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/fast_step.hpp"

namespace cellmirror::inverse_kinematics {

// Postures closer together than this (distance()) count as one.
inline constexpr double kDistinctPostures = 0.1;

class Search {
 public:
  // All three have to outlive the search. `request` is a checked one; its time counts from here.
  Search(const kinematics::Chain& chain, const Request& request, const Clock& clock);

  // Steps from `start`. Whether that led to a solution.
  bool descend(const JointValues& start, int max_iterations, FoundBy by);

  // Keeps a posture found elsewhere, after checking it by the plain forward kinematics and the limits. Of equal ones,
  // the better one is kept.
  bool keep(const JointValues& q, FoundBy by);

  // Remembers the posture for the case that none is found.
  void miss(const JointValues& q, const kinematics::Twist& error);

  // Slides the best solution along its null space downhill in the secondary objective.
  void settle_best();

  [[nodiscard]] std::size_t found() const { return found_.size(); }
  // distance() of the nearest solution to wished().
  [[nodiscard]] double nearest_distance() const;
  // How far the best orientation is off that is only attempted (rad); 0 for what is required.
  [[nodiscard]] double best_attempt() const;
  // Reads the clock, after the first starts; once it is true it stays true.
  [[nodiscard]] bool out_of_time();

  // Where the secondary objective would like the joints to be: the present posture, or the straight boom.
  [[nodiscard]] const JointValues& wished() const { return wished_; }

  [[nodiscard]] Answer finish();

 private:
  struct Found {
    Solution solution;
    double attempt = 0;   // rad, of an orientation that is only attempted
    double distance = 0;  // to wished()
  };
  [[nodiscard]] static bool better(const Found& a, const Found& b);
  void spread_out(std::size_t wanted);

  const kinematics::Chain& chain_;
  const Request& request_;
  JointValues wished_;
  const Clock& clock_;
  Timestamp deadline_;
  bool timed_out_ = false;
  std::size_t starts_ = 0;
  int iterations_ = 0;
  std::vector<Found> found_;
  Solution closest_;  // of those that do not meet the target
  double least_miss_;
};

}  // namespace cellmirror::inverse_kinematics
