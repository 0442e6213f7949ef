#include "rt_core/engine/joint_gate.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::engine {

namespace {

// A driver may stamp a sample while the tick is at work; no clock is ahead by this.
constexpr Nanoseconds kFuture{100'000'000};

bool has(JointSet joints, std::size_t joint) CELL_RT { return ((joints >> joint) & 1U) != 0; }

// Values come, and are not believed: the last good one stands.
bool is_disbelieved(DataState state) CELL_RT { return state == DataState::implausible || state == DataState::conflict; }

// No number where one of them is none: then nothing passes.
double slower(double a, double b) CELL_RT { return std::isnan(a) || a < b ? a : b; }

// By gravity, not by the order of the enumeration: nothing at all is the worst, then values that came and are wrong,
// then lost, stale, fresh.
int gravity_of(DataState state) CELL_RT {
  // none, fresh, stale, lost, invalid, implausible, conflict
  constexpr std::array<int, kDataStates> kGravity = {6, 0, 1, 2, 3, 4, 5};
  return kGravity[static_cast<std::size_t>(state)];
}

}  // namespace

LimiterVerdict JointGate::check_start(std::uint8_t joint_count, std::span<const double> positions,
                                      const JointLimits& limits) CELL_RT {
  return check_setpoints(positions.first(joint_count), std::span(limits.lower).first(joint_count),
                         std::span(limits.upper).first(joint_count));
}

LimiterVerdict JointGate::add(std::uint8_t joint_count, std::span<const double> positions,
                              const JointLimits& limits) CELL_RT {
  const LimiterVerdict verdict = check_start(joint_count, positions, limits);
  if (verdict != LimiterVerdict::passed) return refuse(verdict);
  remove();
  state_.mode = RobotMode::simulated;
  state_.joint_count = joint_count;
  limits_ = limits;
  for (std::size_t i = 0; i < joint_count; ++i) state_.joints[i].position = positions[i];
  return verdict;
}

void JointGate::set_mode(RobotMode mode, const StreamAges& ages, JointSet given,
                         const PlausibilityBounds* bounds) CELL_RT {
  state_.mode = mode;
  ages_ = ages;
  const auto all = static_cast<JointSet>((1U << state_.joint_count) - 1U);
  given_ = (given & all) != 0 ? given : all;
  state_.sequence = 0;
  state_.receive_time = Timestamp{};
  state_.samples = 0;
  state_.refused_values = 0;
  state_.implausible_values = 0;
  state_.conflicting_values = 0;
  state_.newest_implausible = {};
  plausibility_.begin(bounds != nullptr ? *bounds : PlausibilityBounds());
  state_.state = DataState::none;
  // Positions stay: a robot that goes offline stays where it was, one that goes online stays until its first sample.
  for (JointTickState& joint : state_.joints) joint = {.position = joint.position};
  rates_ = {};
}

LimiterVerdict JointGate::refuse(LimiterVerdict verdict) CELL_RT {
  ++state_.refused_setpoints;
  return verdict;
}

LimiterVerdict JointGate::jump(const JointValues& positions, JointSet joints) CELL_RT {
  const LimiterVerdict verdict = check_start(state_.joint_count, positions, limits_);
  if (verdict != LimiterVerdict::passed) return refuse(verdict);
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    if (has(joints, i)) state_.joints[i].position = positions[i];
  }
  stand(joints);
  return verdict;
}

LimiterVerdict JointGate::check(const GatedStep& step, std::array<JointRate, kMaxJointsPerRobot>& rates) const CELL_RT {
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    if (!has(step.joints, i)) continue;
    const double present = state_.joints[i].position;
    const double lower = std::min(limits_.lower[i], present);
    const double upper = std::max(limits_.upper[i], present);
    LimiterVerdict verdict = check_setpoints(std::span(&step.next[i], 1), std::span(&lower, 1), std::span(&upper, 1));
    if (verdict == LimiterVerdict::passed && !std::isfinite(step.velocity[i])) verdict = LimiterVerdict::not_finite;
    if (verdict == LimiterVerdict::passed) {
      const RateLimits limits{.velocity = slower(step.fastest[i], limits_.velocity[i]),
                              .acceleration = limits_.acceleration[i],
                              .jerk = limits_.jerk[i]};
      verdict =
          check_step({.present = present, .next = step.next[i], .dt = step.dt, .before = rates_[i]}, limits, rates[i]);
    }
    if (verdict != LimiterVerdict::passed) return verdict;
  }
  return LimiterVerdict::passed;
}

LimiterVerdict JointGate::step(const GatedStep& step) CELL_RT {
  auto rates = rates_;
  const LimiterVerdict verdict = check(step, rates);
  if (verdict != LimiterVerdict::passed) {
    stand(step.joints);
    return refuse(verdict);
  }
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    if (!has(step.joints, i)) continue;
    state_.joints[i].position = step.next[i];
    state_.joints[i].velocity = step.velocity[i];
  }
  rates_ = rates;
  return verdict;
}

void JointGate::stand(JointSet joints) CELL_RT {
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    if (!has(joints, i)) continue;
    state_.joints[i].velocity = 0;
    rates_[i] = {};
  }
}

void JointGate::take(const JointSample& sample, Timestamp now) CELL_RT {
  if (state_.mode != RobotMode::mirrored) return;
  ++state_.samples;
  const bool begins_anew = sample.sequence == JointSample::kBeginsAnew;
  if (begins_anew) plausibility_.forget();
  state_.sequence = begins_anew ? 0 : sample.sequence;
  state_.receive_time = sample.receive_time;
  const bool timed = sample.receive_time.known() && sample.receive_time - now < kFuture;
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    JointTickState& joint = state_.joints[i];
    const bool present = (sample.present >> i & 1U) != 0;
    const bool finite =
        std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i]) && std::isfinite(sample.effort[i]);
    const bool conflicting = (sample.conflict >> i & 1U) != 0;
    const bool unusable = (present && !finite) || ((present || conflicting) && !timed);
    if ((sample.refused >> i & 1U) != 0 || unusable) {
      ++state_.refused_values;
      joint.state = DataState::invalid;
      continue;
    }
    if (conflicting) {
      ++state_.conflicting_values;
      joint.state = DataState::conflict;
      plausibility_.note_heard(i, sample.receive_time);
    } else if (present) {
      take_joint(sample, i);
    }
  }
}

void JointGate::take_joint(const JointSample& sample, std::size_t i) CELL_RT {
  const PlausibilityVerdict verdict = plausibility_.check(i, {.position = sample.position[i],
                                                              .velocity = sample.velocity[i],
                                                              .effort = sample.effort[i],
                                                              .receive_time = sample.receive_time});
  if (!verdict.shown) return note_implausible(i, verdict, sample.receive_time);
  state_.joints[i] = {.position = sample.position[i],
                      .velocity = sample.velocity[i],
                      .effort = sample.effort[i],
                      .receive_time = sample.receive_time,
                      .source_time = sample.source_time,
                      .state = DataState::fresh};
}

void JointGate::note_implausible(std::size_t i, const PlausibilityVerdict& verdict, Timestamp receive_time) CELL_RT {
  JointTickState& joint = state_.joints[i];
  ++state_.implausible_values;
  joint.state = DataState::implausible;
  if (verdict.why == Implausibility::none) return;  // it is plausible, but not for long enough
  joint.implausible = verdict.why;
  state_.newest_implausible = {.why = verdict.why,
                               .joint = static_cast<std::uint8_t>(i),
                               .value = verdict.value,
                               .bound = verdict.bound,
                               .receive_time = receive_time};
}

// A joint whose values are not believed is lost when they end, not when the last good one is old.
void JointGate::age_joint(std::size_t i, Timestamp now) CELL_RT {
  JointTickState& joint = state_.joints[i];
  if (is_disbelieved(joint.state)) {
    if (now - plausibility_.last_heard(i) > ages_.lost_after) joint.state = DataState::lost;
    return;
  }
  if (!joint.receive_time.known()) return;
  const Nanoseconds age = now - joint.receive_time;
  if (age > ages_.lost_after) {
    joint.state = DataState::lost;
  } else if (age > ages_.stale_after && joint.state != DataState::invalid) {
    joint.state = DataState::stale;
  }
}

void JointGate::age(Timestamp now) CELL_RT {
  if (state_.mode != RobotMode::mirrored) return;
  DataState worst = DataState::fresh;
  for (std::size_t i = 0; i < state_.joint_count; ++i) {
    age_joint(i, now);
    const DataState state = state_.joints[i].state;
    // One that the stream does not give stays as it is: it says nothing about the stream.
    if (has(given_, i) && gravity_of(state) > gravity_of(worst)) worst = state;
  }
  state_.state = worst;
}

}  // namespace cellmirror::engine
