#include "app/gateway/force_worker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rt_core/base/log.hpp"
#include "rt_core/kinematics/joint_motion.hpp"

namespace cellmirror::app {

namespace {

using dynamics::Link;
using dynamics::Mechanism;
using dynamics::RobotMechanism;

// After a warning the effort must fall below this part of the limit before there is another.
constexpr double kBackWithin = 0.95;

const HapticState* haptic_of(const engine::TickState& tick, std::size_t slot) {
  const auto found = std::ranges::find_if(tick.haptics, [&](const HapticState& haptic) {
    return haptic.phase != HapticPhase::closed && haptic.slot == slot;
  });
  return found == tick.haptics.end() ? nullptr : &*found;
}

}  // namespace

bool ForceComputation::take_cell(const std::shared_ptr<const CompiledCell>& cell) {
  if (cell == cell_) return false;
  const bool same = cell_ && dynamics::same_masses(*cell_, *cell);
  cell_ = cell;
  if (same) return false;
  mechanisms_ = dynamics::robot_mechanisms(*cell);
  poses_.reserve(cell->size());
  has_mechanisms_ = false;
  not_computed_.clear();
  for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
    has_mechanisms_ = has_mechanisms_ || mechanisms_[i].mechanism.has_value();
    if (!mechanisms_[i].why_not.empty()) not_computed_.push_back({cell->robots[i].id, mechanisms_[i].why_not});
  }
  return true;
}

bool ForceComputation::take_motion(const engine::TickState& tick) {
  for (const CompiledRobot& robot : cell_->robots) {
    const engine::RobotTickState& from = tick.robots[robot.slot];
    const std::size_t n = robot.joint_names.size();
    if (from.mode == engine::RobotMode::absent || from.joint_count != n) return false;
    JointValues& position = positions_[robot.slot];
    JointValues velocity{};
    for (std::size_t i = 0; i < n; ++i) {
      position[i] = from.joints[i].position;
      velocity[i] = from.joints[i].velocity;
    }
    dynamics::MotionEstimate& motion = motions_[robot.slot];
    const bool mirrored = from.mode == engine::RobotMode::mirrored;
    if (mirrored && from.state != DataState::fresh) {
      motion.stand_still();
    } else {
      motion.take(mirrored ? from.receive_time : tick.time, std::span(position).first(n), std::span(velocity).first(n),
                  mirrored);
    }
  }
  return true;
}

void ForceComputation::place_links(const Mechanism& mechanism, std::span<const double> q) {
  const auto links = mechanism.links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    const int parent = link.parent;
    X_WJ_[i] = parent < 0 ? link.X_PJ : X_WJ_[static_cast<std::size_t>(parent)] * link.X_PJ;
    kinematics::apply_joint(link.kind, link.axis, link.multiplier * q[link.variable] + link.offset, X_WJ_[i]);
  }
}

void ForceComputation::compute_robot(const RobotMechanism& robot, RobotForces& out) {
  const Mechanism& mechanism = *robot.mechanism;
  const CompiledRobot& compiled = *cell_->robot(robot.slot);
  JointValues q{};
  JointValues qd{};
  JointValues qdd{};
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    const auto [slot, joint] = robot.variables[i];
    q[i] = positions_[slot][joint];
    qd[i] = motions_[slot].velocity()[joint];
    qdd[i] = motions_[slot].acceleration()[joint];
  }
  inverse_dynamics(mechanism, {q, qd, qdd, gravity_W_, out.tcp_T.force, out.tcp_T.torque}, output_);
  place_links(mechanism, q);
  out.model_kg = robot.model_kg;
  out.payload_kg = robot.payload_kg;
  out.joints.resize(compiled.joint_names.size());
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    JointForce& joint = out.joints[i];
    joint.name = compiled.joint_names[i];
    joint.kind = compiled.joint_kinds[i];
    joint.position = q[i];
    joint.velocity = qd[i];
    joint.acceleration = qdd[i];
    joint.effort = output_.effort[i];
    joint.max_effort = mechanism.drive(i).max_effort;
    joint.beyond_limit = joint.max_effort > 0.0 && std::abs(joint.effort) > joint.max_effort;
    const auto link = static_cast<std::size_t>(robot.joint_links[i]);
    joint.wrench_J = output_.joint_wrench[link];
    joint.X_WJ = X_WJ_[link];
    joint.axis_J = mechanism.links()[link].axis;
  }
  if (mechanism.tip_link() >= 0) out.X_WT = X_WJ_[static_cast<std::size_t>(mechanism.tip_link())] * mechanism.X_LT();
}

void ForceComputation::watch_limits(const RobotForces& robot) {
  Beyond& beyond = beyond_[robot.slot];
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const JointForce& joint = robot.joints[i];
    bool& was = beyond.joint[i];
    if (joint.beyond_limit && !was) {
      ++limit_warnings_;
      const char* unit = joint.kind == JointKind::prismatic ? "N" : "Nm";
      log_warning("forces.limit", "{} {} needs {:.1f} {}, beyond its {:.1f} {}", robot.id, joint.name, joint.effort,
                  unit, joint.max_effort, unit);
    }
    was = joint.beyond_limit || (was && std::abs(joint.effort) > kBackWithin * joint.max_effort);
  }
}

void ForceComputation::take_tcp(const engine::TickState& tick, std::size_t robot, RobotForces& out) {
  const HapticState* haptic = haptic_of(tick, out.slot);
  out.tcp_known = haptic != nullptr;
  out.tcp_T = {};
  out.X_WT = Pose::Identity();
  if (haptic == nullptr) return;
  // What pushes the hand pushes the tip.
  out.tcp_T = {haptic->force_E, Eigen::Vector3d(0, 0, haptic->axis_torque)};
  const std::optional<Mechanism>& mechanism = mechanisms_[robot].mechanism;
  if (mechanism && mechanism->tip_link() >= 0) return;  // its links tell
  compute_poses(*cell_, positions_, poses_);
  out.X_WT = tcp_poses(cell_->robots[robot], poses_).X_WT;
}

bool ForceComputation::compute(const engine::TickState& tick, ForceState& state) {
  if (!cell_ || !take_motion(tick)) return false;
  state.posture_time = tick.time;
  std::size_t used = 0;
  for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
    const CompiledRobot& robot = cell_->robots[i];
    const bool has_masses = mechanisms_[i].mechanism.has_value();
    if (!has_masses && haptic_of(tick, robot.slot) == nullptr) continue;
    if (state.robots.size() == used) state.robots.emplace_back();
    RobotForces& out = state.robots[used++];
    out.id = robot.id;
    out.slot = static_cast<std::uint8_t>(robot.slot);
    out.computed = has_masses;
    take_tcp(tick, i, out);
    if (has_masses) {
      compute_robot(mechanisms_[i], out);
      watch_limits(out);
    } else {
      out.joints.clear();
      out.model_kg = out.payload_kg = 0;
    }
  }
  state.robots.resize(used);
  return true;
}

ForceWorker::ForceWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock,
                         Nanoseconds tick_period, const Eigen::Vector3d& gravity_W)
    : clock_(clock),
      gravity_W_(gravity_W),
      computation_(gravity_W),
      worker_(
          "forces", *this, [&engine]() -> const engine::TickState& { return engine.force_view(); }, pictures, clock,
          tick_period) {}

void ForceWorker::take_cell(const OwnerPicture& picture) {
  if (!computation_.take_cell(picture.cell)) return;
  for (const NotComputed& robot : computation_.not_computed())
    log_warning("forces.robot", "the forces of {} are not computed: {}", robot.robot, robot.why);
  const std::scoped_lock lock(mutex_);
  not_computed_ = computation_.not_computed();
}

bool ForceWorker::wanted(const OwnerPicture& picture) {
  take_cell(picture);
  const bool wanted = computation_.has_mechanisms() || !picture.haptics.empty();
  if (!wanted) {
    ages_.paused();
    show_nothing();
  }
  const std::scoped_lock lock(mutex_);
  active_ = wanted;
  return wanted;
}

// When the last robot with masses went: whoever shows its efforts and arrows takes them away.
void ForceWorker::show_nothing() {
  const auto last = board_.look();
  if (!last || last->robots.empty()) return;
  std::shared_ptr<ForceState> nothing = states_.take();
  nothing->sequence = ++sequence_;
  nothing->posture_time = last->posture_time;
  nothing->robots.clear();
  board_.hang_up(std::move(nothing));
}

void ForceWorker::run(const OwnerPicture& picture, const engine::TickState& tick) {
  take_cell(picture);
  const Timestamp start = clock_.now();
  std::shared_ptr<ForceState> state = states_.take();
  if (!computation_.compute(tick, *state)) return;
  compute_.record(clock_.now() - start);
  state->sequence = ++sequence_;
  board_.hang_up(std::move(state));
  ages_.shown(tick.time, clock_.now());
  const std::scoped_lock lock(mutex_);
  limit_warnings_ = computation_.limit_warnings();
}

ForceReport ForceWorker::report() const {
  ForceReport report;
  report.gravity_m_s2 = gravity_W_;
  report.state = board_.look();
  report.skipped = worker_.skipped();
  report.rate_hz = worker_.rate_hz();
  report.visible_after = ages_.visible_after().snapshot();
  report.compute = compute_.snapshot();
  const std::scoped_lock lock(mutex_);
  report.active = active_;
  report.not_computed = not_computed_;
  report.limit_warnings = limit_warnings_;
  return report;
}

}  // namespace cellmirror::app
