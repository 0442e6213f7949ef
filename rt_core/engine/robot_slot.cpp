#include "rt_core/engine/robot_slot.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/motion/pursuit.hpp"

namespace cellmirror::engine {

bool RobotSlot::add(const RobotSetup& robot) CELL_RT {
  const std::uint8_t joints = std::min(robot.joint_count, static_cast<std::uint8_t>(kMaxJointsPerRobot));
  if (gate_.add(joints, robot.positions, robot.limits) != LimiterVerdict::passed) return false;
  executor_.reset(joints);
  follower_.reset(joints);
  trajectory_.give_back();
  chain_.give_back();
  give_back_chains();
  return true;
}

void RobotSlot::remove() CELL_RT {
  gate_.remove();
  executor_.reset(0);
  follower_.reset(0);
  trajectory_.give_back();
  chain_.give_back();
  give_back_chains();
}

void RobotSlot::set_mode(const SetMode& command) CELL_RT {
  if (!used()) return;
  gate_.set_mode(command.mode, command.ages, command.given, command.plausibility.get());
  executor_.abort(motion::Outcome::stopped);
  follower_.abort(motion::TrajectoryOutcome::stopped);
  if (!simulated()) {
    executor_.set_chain(nullptr);
    chain_.give_back();
    gate_.set_follow(FollowTickState{});
  }
  give_back_chains();
  gate_.set_motion(executor_.state());
}

bool RobotSlot::set_positions(const JointValues& positions) CELL_RT {
  if (!simulated() || gate_.jump(positions, free_joints()) != LimiterVerdict::passed) return false;
  executor_.abort(motion::Outcome::stopped);
  follower_.abort(motion::TrajectoryOutcome::stopped);
  return true;
}

bool RobotSlot::set_chain(Lease<const kinematics::Chain> chain) CELL_RT {
  if (!simulated() || (chain && chain->variable_count() != state().joint_count)) return false;
  executor_.set_chain(chain.get());
  std::swap(chain_, chain);
  retire(std::move(chain));
  return true;
}

// Once for each chain that moves need beside the present one, so that there is always a place.
void RobotSlot::retire(Lease<const kinematics::Chain> chain) CELL_RT {
  give_back_chains();
  if (!chain || chain.get() == chain_.get() || !executor_.uses(*chain)) return;
  for (std::size_t i = 0; i < retired_; ++i) {
    if (retired_chains_[i].get() == chain.get()) return;
  }
  retired_chains_[retired_++] = std::move(chain);
}

void RobotSlot::give_back_chains() CELL_RT {
  for (std::size_t i = 0; i < retired_;) {
    const kinematics::Chain* const chain = retired_chains_[i].get();
    if (chain != chain_.get() && executor_.uses(*chain)) {
      ++i;
      continue;
    }
    retired_chains_[i].give_back();
    std::swap(retired_chains_[i], retired_chains_[--retired_]);
  }
}

bool RobotSlot::add_move(const motion::Move& move) CELL_RT {
  if (!simulated()) return false;
  follower_.abort(motion::TrajectoryOutcome::superseded);
  return executor_.add(move);
}

bool RobotSlot::follow_trajectory(Lease<const motion::Trajectory> trajectory) CELL_RT {
  // Joints that follow a master are moved by it alone.
  if (!simulated() || !trajectory || state().follow.follows()) return false;
  JointValues velocities{};
  for (std::size_t i = 0; i < state().joint_count; ++i) velocities[i] = state().joints[i].velocity;
  if (!follower_.begin(*trajectory, std::span(velocities).first(state().joint_count))) return false;
  executor_.abort(motion::Outcome::superseded);
  std::swap(trajectory_, trajectory);
  return true;
}

bool RobotSlot::stop_motion() CELL_RT {
  if (simulated()) executor_.stop();
  if (simulated()) follower_.stop(motion::TrajectoryOutcome::stopped);
  return simulated();
}

bool RobotSlot::set_pace(double pace) CELL_RT {
  if (simulated()) executor_.set_pace(pace);
  return simulated();
}

bool RobotSlot::hold_behind(std::uint32_t move) CELL_RT {
  if (simulated()) executor_.hold_behind(move);
  return simulated();
}

bool RobotSlot::move(double dt, Timestamp now) CELL_RT {
  if (!simulated()) return false;
  const std::size_t n = state().joint_count;
  GatedStep step{.joints = free_joints(), .dt = dt};
  JointValues lower{};
  JointValues upper{};
  for (std::size_t i = 0; i < n; ++i) {
    step.next[i] = state().joints[i].position;
    // As in the gate: a joint that stands beyond its range may come back into it.
    lower[i] = std::min(gate_.limits().lower[i], step.next[i]);
    upper[i] = std::max(gate_.limits().upper[i], step.next[i]);
  }
  const motion::JointRange range{std::span(lower).first(n), std::span(upper).first(n)};
  const std::span<double> q = std::span(step.next).first(n);
  const std::span<double> qd = std::span(step.velocity).first(n);
  const bool follows = follower_.active();
  const bool moved = follows ? follower_.step(dt, now, range, q, qd) : executor_.step(dt, now, range, q, qd);
  if (moved) {
    step.fastest = follows ? follower_.fastest() : executor_.fastest();
    if (gate_.step(step) != LimiterVerdict::passed) {
      follower_.abort(motion::TrajectoryOutcome::blocked);
      executor_.abort(motion::Outcome::blocked);
    }
  } else {
    gate_.stand(step.joints);
  }
  if (!follower_.active()) trajectory_.give_back();
  gate_.set_motion(executor_.state());
  give_back_chains();
  return moved;
}

void RobotSlot::set_follow(std::uint8_t master, JointSet joints) CELL_RT {
  // Joints that become free are elsewhere than the move under way has them: it ends where the robot stands.
  const JointSet before = state().follow.joints;
  if ((before & ~joints) != 0) {
    executor_.abort(motion::Outcome::stopped);
  } else {
    executor_.stop();
  }
  follower_.abort(motion::TrajectoryOutcome::stopped);
  gate_.stand(before);
  FollowTickState follow;
  follow.master = master;
  follow.joints = joints;
  gate_.set_follow(follow);
}

bool RobotSlot::follow(const RobotTickState& master, const Coupling& coupling, double dt) CELL_RT {
  if (!simulated()) return false;
  FollowTickState follow = state().follow;
  follow.holding = false;
  follow.limited = 0;
  bool moved = false;
  for (std::size_t i = 0; i < coupling.count; ++i) {
    const CoupledJoint& pair = coupling.joints[i];
    const JointTickState& of_master = master.joints[pair.master_joint];
    const bool known = master.mode == RobotMode::simulated ||
                       (master.mode == RobotMode::mirrored && of_master.state == DataState::fresh);
    if (!known) follow.holding = true;
    moved = follow_joint(known ? &of_master : nullptr, pair.slave_joint, coupling, dt, follow) || moved;
  }
  gate_.set_follow(follow);
  return moved;
}

bool RobotSlot::follow_joint(const JointTickState* master, std::size_t joint, const Coupling& coupling, double dt,
                             FollowTickState& follow) CELL_RT {
  const double present = state().joints[joint].position;
  const double before = gate_.rate(joint).velocity;
  // As in the gate: a joint that stands beyond its range may come back into it.
  const motion::PursuitLimits limits{.lower = std::min(gate_.limits().lower[joint], present),
                                     .upper = std::max(gate_.limits().upper[joint], present),
                                     .velocity = coupling.max_velocity[joint],
                                     .acceleration = coupling.max_acceleration[joint]};
  motion::PursuitStep pursuit{.present = present, .velocity = before, .dt = dt};
  if (master != nullptr) {
    pursuit.target = master->position;
    pursuit.target_velocity = master->velocity;
  }
  const double next = master != nullptr ? motion::pursue(pursuit, limits) : motion::brake(pursuit, limits);
  GatedStep step{.joints = static_cast<JointSet>(1U << joint), .dt = dt};
  step.next[joint] = next;
  step.velocity[joint] = dt > 0.0 ? (next - present) / dt : 0.0;
  // The joint brakes to a limit that was lowered during the motion; the gate must not refuse these steps.
  step.fastest[joint] = std::max(limits.velocity, std::abs(before));
  if (gate_.step(step) != LimiterVerdict::passed) return false;
  const bool limited = master != nullptr && std::abs(master->position - next) > kLimitSlack;
  if (limited) follow.limited = static_cast<JointSet>(follow.limited | 1U << joint);
  return next != present;
}

void RobotSlot::write(StateWriter& out) CELL_RT {
  out(gate_);
  executor_.transfer(out, state().joint_count);
  const kinematics::Chain* chain = chain_.get();
  out.reference(chain);
  out.bounded(retired_, retired_chains_.size());
  for (std::size_t i = 0; i < retired_; ++i) {
    chain = retired_chains_[i].get();
    out.reference(chain);
  }
}

void RobotSlot::restore(StateReader& in, const LendChain& lend) {
  in(gate_);
  executor_.transfer(in, state().joint_count);
  const kinematics::Chain* chain = nullptr;
  in.reference(chain);
  chain_ = lend(chain);
  std::size_t count = 0;
  in.bounded(count, retired_chains_.size());
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    in.reference(chain);
    retire(lend(chain));
  }
}

void RobotSlot::write_trajectory(StateWriter& out) CELL_RT { follower_.transfer(out, state().joint_count); }

void RobotSlot::restore_trajectory(StateReader& in, const LendTrajectory& lend) {
  follower_.transfer(in, state().joint_count);
  trajectory_ = lend(follower_.running());
}

void RobotSlot::publish(RobotTickState& out) const CELL_RT {
  static_cast<RobotTickHead&>(out) = state();
  // Most robots never follow one: then nothing large is copied.
  if (has_trajectory() || out.trajectory.given != 0) out.trajectory = follower_.state();
  std::copy_n(state().joints.begin(), state().joint_count, out.joints.begin());
}

}  // namespace cellmirror::engine
