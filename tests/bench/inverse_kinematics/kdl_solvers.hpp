// Orocos KDL on our chains: the yardstick.
#pragma once

#include <memory>

#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::test_arms {

class KdlSolvers {
 public:
  // Plain chains only. `time_limit_s` bounds the restarts of joint_limited().
  KdlSolvers(const kinematics::Chain& chain, double tolerance, double time_limit_s);
  ~KdlSolvers();
  KdlSolvers(const KdlSolvers&) = delete;
  KdlSolvers& operator=(const KdlSolvers&) = delete;

  // ChainIkSolverPos_LMA: knows no limits. Whether it says that it found one; q is its answer.
  bool levenberg_marquardt(const Pose& X_BG, const JointValues& start, JointValues& q);
  // ChainIkSolverPos_NR_JL, restarted at random postures until the time limit.
  bool joint_limited(const Pose& X_BG, const JointValues& start, JointValues& q);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::test_arms
