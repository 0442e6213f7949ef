#include "rt_core/dynamics/inverse_dynamics.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "rt_core/base/contract.hpp"

namespace cellmirror::dynamics {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Everything in the link's joint frame.
struct LinkState {
  Matrix3d R_PJ;
  Vector3d p_PJ;   // of J, in P
  Vector3d w;      // angular velocity
  Vector3d alpha;  // angular acceleration
  Vector3d a;      // acceleration of the joint's origin, less gravity
};

LinkState move_link(const Link& link, const LinkMotion& motion, const LinkState& before,
                    const DynamicsInput& input) CELL_RT {
  const double value = link.multiplier * input.q[link.variable] + link.offset;
  const Vector3d rate = link.axis * (link.multiplier * input.qd[link.variable]);
  const Vector3d growth = link.axis * (link.multiplier * input.qdd[link.variable]);
  LinkState now;
  if (link.kind == JointKind::prismatic) {
    now.R_PJ = motion.fixed;
    now.p_PJ = motion.p + value * motion.slide;
  } else {
    now.R_PJ = motion.fixed + std::sin(value) * motion.sine + std::cos(value) * motion.cosine;
    now.p_PJ = motion.p;
  }
  const Matrix3d R_JP = now.R_PJ.transpose();
  now.w.noalias() = R_JP * before.w;
  now.alpha.noalias() = R_JP * before.alpha;
  now.a.noalias() = R_JP * (before.a + before.alpha.cross(now.p_PJ) + before.w.cross(before.w.cross(now.p_PJ)));
  if (link.kind == JointKind::prismatic) {
    now.a += growth + 2.0 * now.w.cross(rate);
  } else {
    now.alpha += growth + now.w.cross(rate);
    now.w += rate;
  }
  return now;
}

// Newton and Euler, about the joint's origin.
Wrench inertial_wrench(const Inertia& inertia, const LinkState& state) CELL_RT {
  const Vector3d& c = inertia.p_C;
  Wrench wrench;
  wrench.force = inertia.mass * (state.a + state.alpha.cross(c) + state.w.cross(state.w.cross(c)));
  wrench.torque = inertia.I_C * state.alpha + state.w.cross(inertia.I_C * state.w) + c.cross(wrench.force);
  return wrench;
}

void take_tip_wrench(const Mechanism& mechanism, const DynamicsInput& input, DynamicsOutput& output) CELL_RT {
  if (mechanism.tip_link() < 0) return;
  const Pose& X_LT = mechanism.X_LT();
  const Vector3d tip_force = X_LT.linear() * input.tip_force_T;
  Wrench& wrench = output.joint_wrench[static_cast<std::size_t>(mechanism.tip_link())];
  wrench.force -= tip_force;
  wrench.torque -= X_LT.linear() * input.tip_torque_T + Vector3d(X_LT.translation()).cross(tip_force);
}

}  // namespace

double drive_effort(const Drive& drive, double qd, double qdd) CELL_RT {
  double effort = drive.reflected_inertia() * qdd + drive.viscous_friction * qd;
  if (drive.coulomb_friction != 0.0) effort += drive.coulomb_friction * std::tanh(qd / kFrictionSpeed);
  return effort;
}

void inverse_dynamics(const Mechanism& mechanism, const DynamicsInput& input, DynamicsOutput& output) CELL_RT {
  const std::size_t variables = mechanism.variable_count();
  CELLMIRROR_EXPECTS(input.q.size() >= variables && input.qd.size() >= variables && input.qdd.size() >= variables);
  const auto links = mechanism.links();
  LinkState base;
  base.w.setZero();
  base.alpha.setZero();
  base.a = -input.gravity_B;
  std::array<LinkState, kMaxLinks> states;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const LinkState& before = links[i].parent < 0 ? base : states[static_cast<std::size_t>(links[i].parent)];
    states[i] = move_link(links[i], mechanism.motion(i), before, input);
    output.joint_wrench[i] = inertial_wrench(links[i].inertia, states[i]);
  }
  take_tip_wrench(mechanism, input, output);
  for (std::size_t i = 0; i < variables; ++i) {
    output.effort[i] = drive_effort(mechanism.drive(i), input.qd[i], input.qdd[i]);
  }
  for (std::size_t i = links.size(); i-- > 0;) {
    const Link& link = links[i];
    const Wrench& wrench = output.joint_wrench[i];
    const bool slides = link.kind == JointKind::prismatic;
    output.effort[link.variable] += link.multiplier * link.axis.dot(slides ? wrench.force : wrench.torque);
    if (link.parent < 0) continue;
    Wrench& before = output.joint_wrench[static_cast<std::size_t>(link.parent)];
    const Vector3d force_before = states[i].R_PJ * wrench.force;
    before.force += force_before;
    before.torque += states[i].R_PJ * wrench.torque + states[i].p_PJ.cross(force_before);
  }
}

}  // namespace cellmirror::dynamics
