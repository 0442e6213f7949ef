// Solves a list of targets, measures each and checks each answer by forward kinematics of its own.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::app {

struct IkSettings {
  inverse_kinematics::Method method = inverse_kinematics::Method::automatic;
  kinematics::Task task;
  JointValues start{};  // rad or m
  double tolerance = 1e-5;
  std::chrono::microseconds time_limit{5000};
  std::size_t max_solutions = 1;
};

struct IkOutcome {
  bool solved = false;  // by our own check, not by the solver's word
  bool timed_out = false;
  inverse_kinematics::FoundBy by = inverse_kinematics::FoundBy::nobody;
  double time_us = 0;             // of Solver::solve() alone
  double position_error_m = 0;    // norms of the parts of the task's error
  double rotation_error_rad = 0;  // the same, of the orientation
  JointValues q{};
  std::vector<double> alternatives;  // the other solutions, nearest first, one after the other
};

struct IkRun {
  double setup_ms = 0;  // making the solver, and one solution that is not counted
  std::vector<IkOutcome> outcomes;
  std::size_t false_claims = 0;  // solutions that did not stand our check; they count as not solved
};

// Called from time to time with the number of targets that are done.
using Progress = std::function<void(std::size_t done)>;

// `clock`: for the time limit and for what is measured.
[[nodiscard]] Result<IkRun> run_ik(const kinematics::Chain& chain, const IkSettings& settings,
                                   std::span<const Pose> targets, const Clock& clock, const Progress& progress);

}  // namespace cellmirror::app
