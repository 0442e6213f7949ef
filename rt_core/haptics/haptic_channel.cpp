#include "rt_core/haptics/haptic_channel.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::haptics {

namespace {

constexpr double kTipPlayed = 1e-6;  // m, between the proxy and the tip: as good as equal
// m: at which tissue applies the largest force when it turns the tool, about the size of an effector.
constexpr double kTissueLever = 0.02;

// s
double period_of(Nanoseconds period) CELL_RT { return std::clamp(seconds(period), 1e-5, 0.1); }

ForceLimits force_limits(const HapticSettings& settings) CELL_RT {
  return {.largest = settings.max_force, .largest_rate = settings.max_slew};
}

SampleLimits sample_limits(const HapticSettings& settings) CELL_RT {
  return {
      .uses_pose = settings.drive == Drive::pose, .stale_after = settings.stale_after, .max_speed = settings.max_speed};
}

PassivitySettings passivity_settings(const HapticSettings& settings) CELL_RT {
  return {.control = settings.passivity_control,
          .allowance = settings.energy_allowance,
          .max_damping = settings.max_passivity_damping};
}

// Metres of the cell a metre of what the device moves.
double scale_of(const HapticSettings& settings) CELL_RT {
  return settings.drive == Drive::pose ? settings.workspace_scale : 1.0;
}

// J, that a spring stretched so far may give back through a force that is cut at max_force, as the device feels it.
double recoverable(double elongation, const HapticSettings& settings) CELL_RT {
  const double stiffness = settings.stiffness * settings.force_scale;
  const double full = std::min(elongation, stiffness > 0 ? settings.max_force / stiffness : elongation);
  return (0.5 * stiffness * full * full + settings.max_force * (elongation - full)) / scale_of(settings);
}

// J, of what a spring has stored that now gives the force `size` (N) and is cut at `largest`.
double recoverable(double stored, double size, double largest) CELL_RT {
  const double full = size > largest ? largest / size : 1.0;
  return stored * full * (2 - full);
}

// Whether what the clutch has added to a device's place means the same for the other instrument.
bool lies_as_before(const Instrument& a, const Instrument& b) CELL_RT {
  return a.settings.drive == b.settings.drive && a.settings.X_WD.matrix() == b.settings.X_WD.matrix() &&
         a.settings.workspace_scale == b.settings.workspace_scale && a.joint_count == b.joint_count;
}

}  // namespace

void HapticChannel::open(const Instrument& instrument, HapticDevicePort& port) CELL_RT {
  const std::uint64_t outputs = output_.sequence;
  state_ = HapticState{};
  output_ = HapticOutput{};
  output_.sequence = outputs;
  instrument_ = &instrument;
  gate_.open(port);
  state_.phase = HapticPhase::waiting;
  state_.slot = instrument.slot;
  validator_.restart(Timestamp{});
  models_.restart();
  tissue_ = TissueCoupling{};
  map_.restart();
  target_ = TipTarget{};
  posture_ = Posture{};
  was_engaged_ = false;
  last_bad_ = Timestamp{};
  restart_force();
}

void HapticChannel::close() CELL_RT {
  if (!used()) return;
  restart_force();
  state_.phase = HapticPhase::closed;
  write(last_tick_, output_.period);
  instrument_ = nullptr;
  gate_.close();
}

void HapticChannel::exchange(const Instrument& instrument) CELL_RT {
  if (!used()) return;
  if (!lies_as_before(*instrument_, instrument)) map_.restart();
  instrument_ = &instrument;
  state_.slot = instrument.slot;
  models_.restart();
  tissue_.restart();
  validator_.forget_place();
  if (state_.phase != HapticPhase::faulted) state_.phase = HapticPhase::waiting;
  restart_force();
}

bool HapticChannel::reset() CELL_RT {
  if (state_.phase != HapticPhase::faulted) return false;
  if (!validator_.seen() || last_tick_ - last_bad_ < kQuietBeforeReset) return false;
  take_back_fault();
  ++state_.resets;
  return true;
}

void HapticChannel::take_back_fault() CELL_RT {
  state_.phase = HapticPhase::waiting;
  state_.fault = HapticFault::none;
  state_.awaited = HapticAwaited::nothing;
  was_engaged_ = false;
}

// As a reset does it: the next good sample engages, and the force fades in from zero.
void HapticChannel::engage_again_where_safe(Timestamp now) CELL_RT {
  const HapticSettings& settings = instrument_->settings;
  state_.awaited =
      re_engagement_.awaits({.now = now,
                             .fault = state_.fault,
                             .by_itself = settings.re_engage && validator_.seen(),
                             .last_bad = last_bad_,
                             .model = models_.stale(now, settings.model_stale_after) ? nullptr : models_.model(),
                             .hand = target_.x_WE,
                             .tip = posture_.X_WE.translation()});
  if (state_.awaited != HapticAwaited::nothing) return;
  take_back_fault();
  ++state_.re_engagements;
}

void HapticChannel::restart_force() CELL_RT {
  coupling_.restart();
  gate_.restart();
  tissue_.release();
  reaction_ = TissueReaction{};
  held_force_.setZero();
  stored_energy_ = 0;
  passivity_.restart(target_.p_handle);
  spread({}, Eigen::Vector3d::Zero());
}

// What is wrong in this tick, whether or not something is latched already. The order is that of what explains the rest.
HapticFault HapticChannel::look(const TickInput& input, bool& fresh) CELL_RT {
  const HapticSettings& settings = instrument_->settings;
  HapticSample sample;
  const HapticRead read = gate_.read(sample);
  const Verdict verdict = validator_.validate(read, sample, input.now, sample_limits(settings));
  HapticFault moved = HapticFault::none;
  if (verdict.fresh) {
    const TipTarget target = map_.target(*instrument_, validator_.sample(), posture_.q);
    moved = validator_.moved_to(settings.drive == Drive::pose ? validator_.sample().p_DH : target.x_WE,
                                sample_limits(settings));
    if (moved == HapticFault::none) target_ = target;
  }
  models_.update(input.model, *instrument_, proxy_.x());
  tissue_.take(input.tissue, instrument_->slot, input.now, period_of(input.period));
  fresh = verdict.fresh && moved == HapticFault::none;
  if (input.missed > settings.allowed_missed_periods) return HapticFault::late_tick;
  if (input.device_gone) return HapticFault::vanished;
  if (verdict.fault != HapticFault::none) return verdict.fault;
  if (moved != HapticFault::none) return moved;
  return models_.stale(input.now, settings.model_stale_after) ? HapticFault::stale_model : HapticFault::none;
}

// A missing device, or one that is not ready, is not a fault; invalid data is reported at once. A device that only
// waits for the surroundings of another instrument is supervised as before.
bool HapticChannel::counts_while_waiting(HapticFault fault) const CELL_RT {
  return was_engaged_ || fault == HapticFault::not_finite || fault == HapticFault::jump ||
         fault == HapticFault::two_writers;
}

void HapticChannel::latch(HapticFault fault) CELL_RT {
  if (state_.phase == HapticPhase::faulted) {
    // The same event, known better. A process that ends in order says before that its values do not count any more.
    const bool may_be_an_end =
        state_.fault == HapticFault::stale || state_.fault == HapticFault::invalid || state_.fault == HapticFault::torn;
    if (fault == HapticFault::vanished && may_be_an_end) state_.fault = fault;
    return;
  }
  state_.phase = HapticPhase::faulted;
  state_.fault = fault;
  ++state_.faults;
  re_engagement_.restart();
  restart_force();
}

// Before the surroundings are known, a hand could pass a surface unfelt, and be pushed out of it later.
void HapticChannel::wait_or_engage(const TickInput& input, bool ready) CELL_RT {
  const bool surroundings_known =
      models_.model() != nullptr && !models_.stale(input.now, instrument_->settings.model_stale_after);
  state_.awaits_surroundings = validator_.seen() && !surroundings_known;
  if (ready && surroundings_known) engage(input);
}

void HapticChannel::engage(const TickInput& input) CELL_RT {
  const std::size_t joints = std::min<std::size_t>(instrument_->joint_count, kMaxJointsPerRobot);
  for (std::size_t i = 0; i < joints; ++i) {
    const double stands = i < input.q.size() && std::isfinite(input.q[i]) ? input.q[i] : posture_.q[i];
    posture_.q[i] = within_limits(*instrument_, i, stands);
  }
  const JointValues values = chain_values(*instrument_, posture_.q);
  tip_ = TipPosture{};
  tip_.X_BE = kinematics::forward(instrument_->chain, values, tip_.J);
  posture_.X_WE = instrument_->X_WB * tip_.X_BE;
  map_.anchor_orientation(*instrument_, validator_.sample(), posture_);
  target_ = map_.target(*instrument_, validator_.sample(), posture_.q);
  proxy_.start(posture_.X_WE.translation());
  validator_.forget_place();  // joints without an axis are not where they were assumed
  restart_force();
  was_engaged_ = true;
  state_.phase = HapticPhase::engaging;
}

// A body was put onto the tip: as at an engagement, only what the hand presses on from here is felt.
void HapticChannel::yield_to_what_appeared() CELL_RT {
  ++state_.appeared;
  if (state_.phase == HapticPhase::clutched) return;  // it engages when the clutch is released
  proxy_.start(proxy_.x());
  restart_force();
  state_.phase = HapticPhase::engaging;
}

// While the clutch is pressed the force decreases at max_slew; when it is released, the hand is where the instrument
// is.
void HapticChannel::work_clutch() CELL_RT {
  const int button = instrument_->settings.clutch_button;
  const bool pressed = button >= 0 && button < 32 && (validator_.sample().buttons >> button & 1U) != 0;
  if (pressed) {
    state_.phase = HapticPhase::clutched;
  } else if (state_.phase == HapticPhase::clutched) {
    map_.anchor(*instrument_, validator_.sample(), posture_);
    validator_.forget_place();
    target_ = map_.target(*instrument_, validator_.sample(), posture_.q);
    proxy_.start(posture_.X_WE.translation());
    restart_force();
    state_.phase = HapticPhase::engaging;
  }
}

bool HapticChannel::step(const TickInput& input, JointSample& sample) CELL_RT {
  if (!used()) return false;
  last_tick_ = input.now;
  bool fresh = false;
  const HapticFault fault = look(input, fresh);
  const bool waiting = state_.phase == HapticPhase::waiting;
  state_.awaits_surroundings = false;
  if (fault != HapticFault::none && (!waiting || counts_while_waiting(fault))) {
    last_bad_ = input.now;
    latch(fault);
  }
  if (state_.phase == HapticPhase::waiting) wait_or_engage(input, fault == HapticFault::none && fresh);
  const bool driving = state_.phase != HapticPhase::waiting && state_.phase != HapticPhase::faulted;
  if (driving && !waiting && models_.appeared()) yield_to_what_appeared();
  if (driving) move_and_answer(input);
  if (!gate_.admits(output_, force_limits(instrument_->settings), period_of(input.period))) {
    last_bad_ = input.now;
    latch(HapticFault::not_finite);
  }
  if (state_.phase == HapticPhase::faulted) engage_again_where_safe(input.now);
  write_forces();
  write(input.now, input.period);
  if (!driving || state_.phase == HapticPhase::faulted) return false;
  fill(sample);
  return true;
}

void HapticChannel::move_and_answer(const TickInput& input) CELL_RT {
  const HapticSettings& settings = instrument_->settings;
  const double period = period_of(input.period);
  passivity_.observe(target_.p_handle, held_force_, stored_energy_, passivity_settings(settings), period);
  work_clutch();
  ProxyContact contact;
  if (state_.phase != HapticPhase::clutched) {
    const Eigen::Vector3d before = proxy_.x();
    contact = proxy_.follow(models_.model(), target_.x_WE,
                            {.at_rest = settings.static_friction, .sliding = settings.dynamic_friction},
                            settings.max_speed * scale_of(settings) * period);
    stand_at(before);
  }
  if (settings.gripper_joint >= 0 && variable_of(*instrument_, settings.gripper_joint) < 0) {
    posture_.q[static_cast<std::size_t>(settings.gripper_joint)] = gripper_value(*instrument_, validator_.sample());
  }
  const Eigen::Vector3d force = answer(contact, period);
  if (passivity_.lost(passivity_settings(settings))) {
    last_bad_ = input.now;
    latch(HapticFault::not_passive);
    return;
  }
  held_force_ = force;
  spread(contact, force);
  if (state_.phase == HapticPhase::engaging && coupling_.faded_in() >= 1.0 && !proxy_.approaching()) {
    state_.phase = HapticPhase::active;
  }
}

// Brings the instrument to the proxy. Where its joints do not reach, the proxy is where the tip is, unless that is
// inside of a body.
void HapticChannel::stand_at(const Eigen::Vector3d& x_before) CELL_RT {
  const Instrument& instrument = *instrument_;
  const HapticSettings& settings = instrument.settings;
  const Pose X_BW = instrument.X_WB.inverse();
  JointValues q = posture_.q;
  if (settings.drive == Drive::joints) {
    q = target_.q;
  } else if (settings.gripper_joint >= 0) {
    q[static_cast<std::size_t>(settings.gripper_joint)] = gripper_value(instrument, validator_.sample());
  }
  JointValues values = chain_values(instrument, q);
  const JointValues lower = chain_values(instrument, instrument.lower);
  const JointValues upper = chain_values(instrument, instrument.upper);
  const int gripper = settings.gripper_joint >= 0 ? variable_of(instrument, settings.gripper_joint) : -1;
  const TipGoal goal{.p_BE = X_BW * proxy_.x(), .R_BE = X_BW.linear() * target_.R_WE};
  const TipPosture tip = solve_tip(
      instrument.chain, goal, {.lower = lower, .upper = upper, .fixed = gripper >= 0 ? 1U << gripper : 0U}, values);
  const Pose X_WE = instrument.X_WB * tip.X_BE;
  const ContactModel* model = models_.model();
  if (!tip.met) {
    if (model != nullptr && violation(*model, X_WE.translation()) > violation(*model, x_before) + kTipPlayed) {
      proxy_.settle_at(x_before);
      return;
    }
    proxy_.settle_at(X_WE.translation());
  }
  tip_ = tip;
  posture_.X_WE = X_WE;
  for (std::size_t i = 0; i < instrument.chain.variable_count(); ++i) {
    q[instrument.variable_joint[i]] = values[i];
  }
  posture_.q = q;
}

// The force at the device, in the world's axes.
Eigen::Vector3d HapticChannel::answer(const ProxyContact& contact, double period) CELL_RT {
  const HapticSettings& settings = instrument_->settings;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  stored_energy_ = 0;
  if (state_.phase != HapticPhase::clutched && !proxy_.approaching()) {
    const CouplingSettings spring{
        .stiffness = settings.stiffness, .damping = settings.damping, .engage_time = seconds(settings.engage_time)};
    force = coupling_.force(contact.elongation, contact.normal, spring, period) * settings.force_scale;
    stored_energy_ = recoverable(contact.elongation.norm(), settings);
    if (tissue_.known()) {
      coupling_force_ = settings.force_scale > 0 ? force.norm() / settings.force_scale : 0.0;
      force += feel_tissue(contact, period);
    }
  } else {
    reaction_ = TissueReaction{};
    tissue_.release();
  }
  const Eigen::Vector3d wanted = force;
  force = passivity_.control(force, passivity_settings(settings), period);
  force = gate_.limit(force, force_limits(settings), period);
  if (gate_.cut()) ++state_.saturated;
  const double square = wanted.squaredNorm();
  passed_ = square > 0 ? std::clamp(wanted.dot(force) / square, 0.0, 1.0) : 1.0;
  return force;
}

// The tissue's force at the device, in the world's axes. It acts on the tip, which rests while the hand presses on into
// a wall: then that part of the way stores energy too.
Eigen::Vector3d HapticChannel::feel_tissue(const ProxyContact& contact, double period) CELL_RT {
  const HapticSettings& settings = instrument_->settings;
  const double scale = settings.force_scale;
  const double largest = scale > 0 ? settings.max_force / scale : 0.0;  // N of the cell
  const TissueLimits limits{.stiffness = settings.stiffness,
                            .torque = largest * kTissueLever,
                            .torque_rate = scale > 0 ? settings.max_slew / scale * kTissueLever : 0.0};
  reaction_ = tissue_.react(tissue_tip(tip_, instrument_->X_WB), limits, coupling_.faded_in(), period);
  const double size = reaction_.force_W.norm();
  const double stored = recoverable(reaction_.stored, size, largest) + size * contact.elongation.norm();
  stored_energy_ += stored * scale / scale_of(settings);
  return reaction_.force_W * scale;
}

// The force in all output forms.
void HapticChannel::spread(const ProxyContact& contact, const Eigen::Vector3d& force_device) CELL_RT {
  state_.contacts = contact.contacts;
  state_.passivity_damping = passivity_.damping();
  state_.tissue_force_W.setZero();
  const bool nothing = force_device.isZero(0) && reaction_.axis_torque == 0;
  if (instrument_ == nullptr || nothing || instrument_->settings.force_scale <= 0) {
    state_.force_W.setZero();
    state_.force_E.setZero();
    state_.axis_torque = 0;
    state_.joint_torques = JointValues{};
    output_.gripper_torque = 0;
    output_.force_D.setZero();
    output_.force_E.setZero();
    output_.torque_D.setZero();
    output_.joint_torques = JointValues{};
    return;
  }
  const HapticSettings& settings = instrument_->settings;
  const double scale = settings.force_scale;
  state_.force_W = force_device / scale;
  state_.force_E = posture_.X_WE.linear().transpose() * state_.force_W;
  const Eigen::Vector3d axis_W = posture_.X_WE.linear().col(2);
  state_.axis_torque = 0;
  const ContactModel* model = models_.model();
  double pressed = 0;
  for (std::size_t k = 0; model != nullptr && k < contact.held.active_count; ++k) {
    const ContactConstraint& constraint = model->constraints[contact.held.active[k]];
    const Eigen::Vector3d lever = constraint.point - model->x_ref;
    pressed += contact.held.multiplier[k];
    state_.axis_torque += contact.held.multiplier[k] * lever.cross(constraint.normal).dot(axis_W);
  }
  // Cut and faded as the force is.
  const double elongation = contact.elongation.norm();
  const double spring = tissue_.known() ? coupling_force_ * passed_ : state_.force_W.norm();
  state_.axis_torque *= pressed > 0 && elongation > 0 ? spring / elongation : 0.0;
  if (tissue_.known()) {
    state_.tissue_force_W = reaction_.force_W * passed_;
    state_.axis_torque += reaction_.axis_torque * passed_;
  }
  const Eigen::Matrix3d R_BW = instrument_->X_WB.linear().transpose();
  Eigen::Matrix<double, 6, 1> wrench_B;
  wrench_B << R_BW * state_.force_W, R_BW * (state_.axis_torque * axis_W);
  state_.joint_torques = JointValues{};
  output_.joint_torques = JointValues{};
  for (std::size_t i = 0; i < instrument_->chain.variable_count(); ++i) {
    const std::size_t joint = instrument_->variable_joint[i];
    state_.joint_torques[joint] = tip_.J.col(static_cast<Eigen::Index>(i)).dot(wrench_B);
    output_.joint_torques[joint] = state_.joint_torques[joint] * scale;
  }
  const Eigen::Matrix3d R_DW = settings.X_WD.linear().transpose();
  const double torque_scale = scale / scale_of(settings);
  output_.force_D = R_DW * force_device;
  output_.force_E = state_.force_E;
  output_.torque_D = R_DW * (axis_W * (state_.axis_torque * torque_scale));
  output_.gripper_torque = 0;
  if (settings.gripper_joint >= 0) {
    output_.gripper_torque =
        state_.joint_torques[static_cast<std::size_t>(settings.gripper_joint)] * settings.gripper_scale * torque_scale;
  }
}

void HapticChannel::write(Timestamp now, Nanoseconds period) CELL_RT {
  ++output_.sequence;
  output_.time = now;
  output_.period = period;
  output_.answers = validator_.sample().sequence;
  output_.phase = static_cast<std::uint32_t>(state_.phase);
  output_.fault = static_cast<std::uint32_t>(state_.fault);
  output_.joint_count = instrument_->joint_count;
  output_.max_force = instrument_->settings.max_force;
  gate_.write(output_, force_limits(instrument_->settings), period_of(period));
}

void HapticChannel::write_forces() CELL_RT {
  const HapticSample& sample = validator_.sample();
  state_.device_sequence = sample.sequence;
  state_.device_writer = sample.writer;
  state_.device_time = sample.time;
  state_.buttons = sample.buttons;
  state_.samples = validator_.samples();
  state_.skipped = validator_.skipped();
  state_.torn = validator_.torn();
  state_.x_device = target_.x_WE;
  state_.x_proxy = proxy_.x();
  state_.energy = passivity_.energy();
  state_.model_time = models_.model() != nullptr ? models_.model()->posture_time : Timestamp{};
  state_.tissue_time = tissue_.newest().posture_time;
  state_.tissue_contacts = tissue_.newest().contacts;
  state_.tissue_held = tissue_.newest().held;
  state_.tissue_late = tissue_.late();
  state_.tissue_refused = tissue_.refused();
}

void HapticChannel::fill(JointSample& sample) const CELL_RT {
  sample = JointSample{};
  sample.receive_time = validator_.received();
  sample.source_time = validator_.sample().time;
  sample.sequence = validator_.sample().sequence;
  const std::size_t joints = std::min<std::size_t>(instrument_->joint_count, kMaxJointsPerRobot);
  sample.present = static_cast<std::uint32_t>((std::uint64_t{1} << joints) - 1);
  for (std::size_t i = 0; i < joints; ++i) sample.position[i] = within_limits(*instrument_, i, posture_.q[i]);
}

}  // namespace cellmirror::haptics
