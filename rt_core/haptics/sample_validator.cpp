#include "rt_core/haptics/sample_validator.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::haptics {

namespace {

constexpr double kFarthestPose = 100.0;    // m or rad: beyond it a number is no place and no angle
constexpr double kLeastQuaternion = 0.25;  // squared norm: less is no rotation
constexpr double kLargestQuaternion = 4.0;
constexpr double kJumpSlack = 0.5e-3;         // m: an encoder's steps and the jitter of stamps
constexpr double kShortestInterval = 250e-6;  // s: no device distinguishes timestamps nearer than this

bool finite(const HapticSample& sample) CELL_RT {
  bool all = sample.p_DH.allFinite() && sample.q_DH.coeffs().allFinite() && std::isfinite(sample.gripper);
  const std::size_t count = std::min<std::size_t>(sample.axis_count, kMaxHapticAxes);
  for (std::size_t i = 0; i < count; ++i) all = all && std::isfinite(sample.axes[i]);
  return all;
}

bool is_rotation(const HapticSample& sample) CELL_RT {
  const double square = sample.q_DH.squaredNorm();
  return square >= kLeastQuaternion && square <= kLargestQuaternion;
}

bool plausible(const HapticSample& sample) CELL_RT {
  if (!sample.valid || sample.axis_count > kMaxHapticAxes) return false;
  double largest = std::max(sample.p_DH.cwiseAbs().maxCoeff(), std::abs(sample.gripper));
  for (std::size_t i = 0; i < sample.axis_count; ++i) largest = std::max(largest, std::abs(sample.axes[i]));
  return largest <= kFarthestPose;
}

Nanoseconds distance(Timestamp a, Timestamp b) CELL_RT { return a < b ? b - a : a - b; }

}  // namespace

void SampleValidator::restart(Timestamp now) CELL_RT {
  *this = SampleValidator{};
  received_ = now;
}

void SampleValidator::take(const HapticSample& sample, Timestamp now) CELL_RT {
  last_ = sample;
  seen_ = true;
  received_ = now;
  ++samples_;
}

// A timestamp ahead of our clock by more than the permitted age is from another clock and gives no age.
bool SampleValidator::old(Timestamp now, const SampleLimits& settings) const CELL_RT {
  return distance(now, last_.time) > settings.stale_after || now - received_ > settings.stale_after;
}

// Two processes that write in exact step show one of them in every tick; but more was written than this one counts.
bool SampleValidator::has_other_writer(const HapticSample& sample) const CELL_RT {
  if (sample.writer != writer_ || sample.sequence <= count_ || sample.writes <= writes_ || writes_ == 0) return false;
  return sample.writes - writes_ > sample.sequence - count_;
}

Verdict SampleValidator::validate_new(const HapticSample& sample, Timestamp now, const SampleLimits& settings) CELL_RT {
  const bool another_writer = writer_known_ && sample.writer != writer_;
  const bool backwards = writer_known_ && !another_writer && sample.sequence < count_;
  const bool standing_still = writer_known_ && !another_writer && sample.sequence == count_;
  const bool in_step = writer_known_ && has_other_writer(sample);
  const std::uint64_t before = count_;
  writes_ = sample.writes;
  writer_ = sample.writer;
  count_ = sample.sequence;
  const bool first = !writer_known_;
  writer_known_ = true;
  if (another_writer || backwards || in_step) {
    forget_place();
    // If the last sample is old, this is a restarted device, or another one that takes over. Its first sample may be
    // anywhere, so it does not count; without a driven instrument this has no effect.
    if (seen_) return {.fault = old(now, settings) ? HapticFault::stale : HapticFault::two_writers};
  }
  if (standing_still) return {.fault = old(now, settings) ? HapticFault::stale : HapticFault::none};
  if (!finite(sample) || (settings.uses_pose && !is_rotation(sample))) return {.fault = HapticFault::not_finite};
  if (!plausible(sample)) return {.fault = HapticFault::invalid};
  if (sample.time.ns < 0 || distance(now, sample.time) > settings.stale_after) return {.fault = HapticFault::stale};
  if (!first && !another_writer && !backwards) skipped_ += sample.sequence - before - 1;
  take(sample, now);
  return {.fresh = true};
}

Verdict SampleValidator::validate(HapticRead read, const HapticSample& sample, Timestamp now,
                                  const SampleLimits& settings) CELL_RT {
  if (read == HapticRead::fresh) {
    tearing_ = false;
    return validate_new(sample, now, settings);
  }
  if (read == HapticRead::torn) ++torn_;
  tearing_ = read == HapticRead::torn;
  if (!old(now, settings)) return {};
  return {.fault = tearing_ ? HapticFault::torn : HapticFault::stale};
}

HapticFault SampleValidator::moved_to(const Eigen::Vector3d& p, const SampleLimits& settings) CELL_RT {
  const bool known = place_known_;
  const double way = (p - place_).norm();
  const Nanoseconds between = last_.time - place_time_;
  place_ = p;
  place_time_ = last_.time;
  place_known_ = true;
  if (!known) return HapticFault::none;
  const double interval = std::max(std::min(seconds(between), seconds(settings.stale_after) * 2), kShortestInterval);
  return way > settings.max_speed * interval + kJumpSlack ? HapticFault::jump : HapticFault::none;
}

}  // namespace cellmirror::haptics
