#include "rt_core/engine/robot_slot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "rt_core/engine/limiter.hpp"

namespace cellmirror::engine {

namespace {

// By gravity, not by the order of the enumeration: nothing at all is the worst, then invalid, lost, stale, fresh.
int gravity_of(DataState state) CELL_RT {
  constexpr std::array<int, 5> kGravity = {4, 0, 1, 2, 3};  // none, fresh, stale, lost, invalid
  return kGravity[static_cast<std::size_t>(state)];
}

}  // namespace

bool RobotSlot::apply(const Command& command) CELL_RT {
  switch (command.kind) {
    case CommandKind::add_robot:
      add(command);
      return true;
    case CommandKind::remove_robot:
      state_ = RobotTickState{};
      executor_.reset(0);
      return true;
    case CommandKind::set_mode:
      set_mode(command);
      return true;
    case CommandKind::set_positions:
      return set_positions(command);
    case CommandKind::set_limits:
      lower_ = command.lower;
      upper_ = command.upper;
      return true;
    case CommandKind::set_chain:
      return set_chain(command.chain);
    case CommandKind::stop_motion:
      if (!simulated()) return false;
      executor_.stop();
      return true;
    case CommandKind::set_pace:
      if (!simulated()) return false;
      executor_.set_pace(command.pace);
      return true;
    case CommandKind::hold_behind:
      if (!simulated()) return false;
      executor_.hold_behind(command.last_move);
      return true;
    case CommandKind::open_haptic:
    case CommandKind::close_haptic:
    case CommandKind::reset_haptic:
    case CommandKind::haptic_device:
    case CommandKind::couple:
    case CommandKind::uncouple:
      return false;  // the engine asks its couplings
    case CommandKind::add_move:
      return false;  // the engine carries them out itself
  }
  return false;
}

void RobotSlot::add(const Command& command) CELL_RT {
  state_ = RobotTickState{};
  state_.mode = RobotMode::simulated;
  state_.joint_count = std::min(command.joint_count, static_cast<std::uint8_t>(kMaxJointsPerRobot));
  executor_.reset(state_.joint_count);
  lower_ = command.lower;
  upper_ = command.upper;
  for (std::size_t i = 0; i < state_.joint_count; ++i) state_.joints[i].position = command.values[i];
}

void RobotSlot::set_mode(const Command& command) CELL_RT {
  if (!used()) return;
  state_.mode = command.mode;
  executor_.abort(motion::Outcome::stopped);
  if (!simulated()) {
    executor_.set_chain(nullptr);
    state_.follow = {};
  }
  state_.motion = executor_.state();
  ages_ = command.ages;
  const auto all = static_cast<std::uint16_t>((1U << state_.joint_count) - 1U);
  given_ = (command.given & all) != 0 ? command.given : all;
  state_.sequence = 0;
  state_.receive_time = Timestamp{};
  state_.samples = 0;
  state_.refused_values = 0;
  state_.state = DataState::none;
  // Positions stay: a robot that goes offline stays where it was, one that goes online stays until its first sample.
  for (JointTickState& joint : state_.joints) {
    joint.velocity = 0;
    joint.effort = 0;
    joint.receive_time = Timestamp{};
    joint.source_time = Timestamp{};
    joint.state = DataState::none;
  }
}

bool RobotSlot::set_positions(const Command& command) CELL_RT {
  if (!simulated()) return false;
  const std::size_t n = state_.joint_count;
  const LimiterVerdict verdict =
      check_setpoints(std::span(command.values).first(n), std::span(lower_).first(n), std::span(upper_).first(n));
  if (verdict != LimiterVerdict::passed) {
    ++state_.refused_setpoints;
    return false;
  }
  executor_.abort(motion::Outcome::stopped);
  for (std::size_t i = 0; i < n; ++i) {
    if (follows(i)) continue;
    state_.joints[i].position = command.values[i];
    state_.joints[i].velocity = 0;
  }
  return true;
}

bool RobotSlot::set_chain(const kinematics::Chain* chain) CELL_RT {
  if (!simulated() || (chain != nullptr && chain->variable_count() != state_.joint_count)) return false;
  executor_.set_chain(chain);
  return true;
}

bool RobotSlot::add_move(const motion::Move& move) CELL_RT { return simulated() && executor_.add(move); }

bool RobotSlot::move(double dt, Timestamp now) CELL_RT {
  if (!simulated()) return false;
  const std::size_t n = state_.joint_count;
  JointValues present{};
  JointValues lower{};
  JointValues upper{};
  for (std::size_t i = 0; i < n; ++i) {
    present[i] = state_.joints[i].position;
    // A joint that stands beyond its range, since that was narrowed, may come back into it, and not go further.
    lower[i] = std::min(lower_[i], present[i]);
    upper[i] = std::max(upper_[i], present[i]);
  }
  JointValues next = present;
  JointValues velocity{};
  const bool moved = executor_.step(dt, now, {std::span(lower).first(n), std::span(upper).first(n)},
                                    std::span(next).first(n), std::span(velocity).first(n));
  if (moved) {
    for (std::size_t i = 0; i < n; ++i) {
      if (follows(i)) next[i] = present[i];
    }
    LimiterVerdict verdict =
        check_setpoints(std::span(next).first(n), std::span(lower).first(n), std::span(upper).first(n));
    if (verdict == LimiterVerdict::passed) {
      verdict = check_rates(std::span(present).first(n), std::span(next).first(n),
                            std::span(executor_.fastest()).first(n), dt);
    }
    if (verdict != LimiterVerdict::passed) {
      ++state_.refused_setpoints;
      executor_.abort(motion::Outcome::blocked);
      next = present;
      velocity.fill(0);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (follows(i)) continue;
      state_.joints[i].position = next[i];
      state_.joints[i].velocity = velocity[i];
    }
  }
  state_.motion = executor_.state();
  return moved;
}

void RobotSlot::set_follow(std::uint8_t master, std::uint16_t joints) CELL_RT {
  // Joints that become free are elsewhere than the move under way has them: it ends where the robot stands.
  if ((state_.follow.joints & ~joints) != 0) {
    executor_.abort(motion::Outcome::stopped);
  } else {
    executor_.stop();
  }
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    if (follows(i)) state_.joints[i].velocity = 0;
  }
  state_.follow = {};
  state_.follow.master = master;
  state_.follow.joints = joints;
}

bool RobotSlot::follow(const RobotTickState& master, const Coupling& coupling, double dt) CELL_RT {
  if (!simulated()) return false;
  state_.follow.holding = false;
  state_.follow.limited = 0;
  bool moved = false;
  for (std::size_t i = 0; i < coupling.count; ++i) {
    const CoupledJoint& pair = coupling.joints[i];
    const JointTickState& of_master = master.joints[pair.master_joint];
    const bool known = master.mode == RobotMode::simulated ||
                       (master.mode == RobotMode::mirrored && of_master.state == DataState::fresh);
    if (!known) {
      state_.follow.holding = true;
      state_.joints[pair.slave_joint].velocity = 0;
      continue;
    }
    const double max_step = coupling.max_velocity[pair.slave_joint] * dt;
    moved = follow_joint(of_master, pair.slave_joint, max_step, dt) || moved;
  }
  return moved;
}

bool RobotSlot::follow_joint(const JointTickState& master, std::size_t joint, double max_step, double dt) CELL_RT {
  JointTickState& own = state_.joints[joint];
  const double present = own.position;
  // One that stands beyond its range, since that was narrowed, may come back into it, and not go further.
  const double lower = std::min(lower_[joint], present);
  const double upper = std::max(upper_[joint], present);
  const double wanted = std::clamp(master.position, lower, upper);
  const double next = present + std::clamp(wanted - present, -max_step, max_step);
  if (check_setpoints(std::span(&next, 1), std::span(&lower, 1), std::span(&upper, 1)) != LimiterVerdict::passed) {
    ++state_.refused_setpoints;
    own.velocity = 0;
    return false;
  }
  if (std::abs(master.position - next) > kLimitSlack)
    state_.follow.limited = static_cast<std::uint16_t>(state_.follow.limited | 1U << joint);
  own.position = std::abs(wanted - present) <= max_step ? wanted : next;
  own.velocity = dt > 0.0 ? (own.position - present) / dt : 0.0;
  return own.position != present;
}

void RobotSlot::take(const JointSample& sample) CELL_RT {
  if (state_.mode != RobotMode::mirrored) return;
  ++state_.samples;
  state_.sequence = sample.sequence;
  state_.receive_time = sample.receive_time;
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    JointTickState& joint = state_.joints[i];
    const bool present = (sample.present >> i & 1U) != 0;
    const bool finite =
        std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i]) && std::isfinite(sample.effort[i]);
    if ((sample.refused >> i & 1U) != 0 || (present && !finite)) {
      ++state_.refused_values;
      joint.state = DataState::invalid;
      continue;
    }
    if (!present) continue;
    joint.position = sample.position[i];
    joint.velocity = sample.velocity[i];
    joint.effort = sample.effort[i];
    joint.receive_time = sample.receive_time;
    joint.source_time = sample.source_time;
    joint.state = DataState::fresh;
  }
}

void RobotSlot::update(Timestamp now) CELL_RT {
  if (state_.mode != RobotMode::mirrored) return;
  DataState worst = DataState::fresh;
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    JointTickState& joint = state_.joints[i];
    if (joint.receive_time.known()) {
      const Nanoseconds age = now - joint.receive_time;
      if (age > ages_.lost_after) {
        joint.state = DataState::lost;
      } else if (age > ages_.stale_after) {
        joint.state = joint.state == DataState::invalid ? DataState::invalid : DataState::stale;
      }
    }
    // One that nothing gives stays as it is for ever: it says nothing about the stream.
    if (gives(i) && gravity_of(joint.state) > gravity_of(worst)) worst = joint.state;
  }
  state_.state = worst;
}

void RobotSlot::publish(RobotTickState& out) const CELL_RT {
  static_cast<RobotTickHead&>(out) = state_;
  std::copy_n(state_.joints.begin(), state_.joint_count, out.joints.begin());
}

}  // namespace cellmirror::engine
