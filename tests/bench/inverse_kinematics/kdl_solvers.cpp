#include "tests/bench/inverse_kinematics/kdl_solvers.hpp"

#include <time.h>

#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <limits>
#include <random>

namespace cellmirror::test_arms {

namespace {

KDL::Frame to_kdl(const Pose& X) {
  const Eigen::Matrix3d R = X.linear();
  const Eigen::Vector3d p = X.translation();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

KDL::Chain to_kdl(const kinematics::Chain& chain) {
  KDL::Chain kdl;
  kdl.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(chain.joints()[0].X_PJ)));
  for (std::size_t i = 0; i < chain.joints().size(); ++i) {
    const auto type =
        chain.joints()[i].kind == JointKind::prismatic ? KDL::Joint(KDL::Joint::TransZ) : KDL::Joint(KDL::Joint::RotZ);
    const Pose& X_next = i + 1 < chain.joints().size() ? chain.joints()[i + 1].X_PJ : chain.X_LT();
    kdl.addSegment(KDL::Segment(type, to_kdl(X_next)));
  }
  return kdl;
}

double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

KDL::JntArray limits(const kinematics::Chain& chain, bool upper) {
  KDL::JntArray values(static_cast<unsigned>(chain.variable_count()));
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const double limit = upper ? chain.upper()[i] : chain.lower()[i];
    values(static_cast<unsigned>(i)) = std::isfinite(limit) ? limit : std::copysign(1e9, limit);
  }
  return values;
}

}  // namespace

struct KdlSolvers::Parts {
  Parts(const kinematics::Chain& from, double tolerance_, double time_limit)
      : chain(to_kdl(from)),
        n(static_cast<unsigned>(from.variable_count())),
        lower(limits(from, false)),
        upper(limits(from, true)),
        forward(chain),
        velocity(chain),
        lma(chain, Eigen::Matrix<double, 6, 1>::Ones(), tolerance_),
        newton(chain, lower, upper, forward, velocity, 100, tolerance_),
        time_limit_s(time_limit) {}
  KDL::Chain chain;
  unsigned n;
  KDL::JntArray lower;
  KDL::JntArray upper;
  KDL::ChainFkSolverPos_recursive forward;
  KDL::ChainIkSolverVel_pinv velocity;
  KDL::ChainIkSolverPos_LMA lma;
  KDL::ChainIkSolverPos_NR_JL newton;
  double time_limit_s;
};

KdlSolvers::KdlSolvers(const kinematics::Chain& chain, double tolerance, double time_limit_s)
    : parts_(std::make_unique<Parts>(chain, tolerance, time_limit_s)) {}
KdlSolvers::~KdlSolvers() = default;

bool KdlSolvers::levenberg_marquardt(const Pose& X_BG, const JointValues& start, JointValues& q) {
  KDL::JntArray from(parts_->n);
  KDL::JntArray to(parts_->n);
  for (unsigned i = 0; i < parts_->n; ++i) from(i) = start[i];
  const bool found = parts_->lma.CartToJnt(from, to_kdl(X_BG), to) >= 0;
  for (unsigned i = 0; i < parts_->n; ++i) q[i] = to(i);
  return found;
}

bool KdlSolvers::joint_limited(const Pose& X_BG, const JointValues& start, JointValues& q) {
  const double deadline = processor_time_s() + parts_->time_limit_s;  // so that others on the machine cost it no tries
  std::mt19937_64 random(1);
  KDL::JntArray from(parts_->n);
  KDL::JntArray to(parts_->n);
  for (unsigned i = 0; i < parts_->n; ++i) from(i) = start[i];
  bool found = false;
  do {
    found = parts_->newton.CartToJnt(from, to_kdl(X_BG), to) >= 0;
    for (unsigned i = 0; i < parts_->n; ++i) {
      const bool bounded = parts_->upper(i) < 1e8;
      from(i) = std::uniform_real_distribution<double>(bounded ? parts_->lower(i) : -M_PI,
                                                       bounded ? parts_->upper(i) : M_PI)(random);
    }
  } while (!found && processor_time_s() < deadline);
  for (unsigned i = 0; i < parts_->n; ++i) q[i] = to(i);
  return found;
}

}  // namespace cellmirror::test_arms
