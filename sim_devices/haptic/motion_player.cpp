#include "sim_devices/haptic/motion_player.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::sim {
namespace {

constexpr double kPressRise = 0.2;          // s, in which a press gets deeper
constexpr double kMinimumJerkPeak = 1.875;  // largest speed of a minimum-jerk motion over its mean speed

// Position over distance, 0 to 1, smooth to the third derivative at both ends (Flash, Hogan 1985).
double minimum_jerk(double s) { return s * s * s * (10 + s * (6 * s - 15)); }

// What pushes against a direction.
double resistance(const Coordinates& efforts, const Coordinates& direction) {
  double along = 0;
  for (std::size_t i = 0; i < efforts.size(); ++i) along += efforts[i] * direction[i];
  return -along;
}

double distance(const Coordinates& a, const Coordinates& b) {
  double squared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squared += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squared);
}

}  // namespace

MotionPlayer::MotionPlayer(std::vector<MotionStep> steps, const Coordinates& start, bool repeat)
    : steps_(std::move(steps)), start_(start), repeat_(repeat) {
  wish_.position = start;
}

const HandTarget& MotionPlayer::step(const Coordinates& hand, const Coordinates& efforts, double dt) {
  const Coordinates before = wish_.position;
  t_ += dt;
  // Steps without a duration follow each other in one call, but never the whole list twice.
  for (std::size_t guard = 0; guard <= steps_.size() && !done(); ++guard) {
    if (!begun_) begin(steps_[next_]);
    if (!play(steps_[next_], hand, efforts)) break;
    begun_ = false;
    ++next_;
    if (done() && repeat_) next_ = 0;
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    wish_.rate[i] = wish_.holding && dt > 0 ? (wish_.position[i] - before[i]) / dt : 0;
  }
  return wish_;
}

void MotionPlayer::replace(std::vector<MotionStep> steps) {
  steps_ = std::move(steps);
  next_ = 0;
  begun_ = false;
  wish_.holding = true;
}

void MotionPlayer::begin(const MotionStep& step) {
  begun_ = true;
  t_ = 0;
  from_ = wish_.position;
  turn_at_ = -1;
  if (step.verb == MotionVerb::touch || step.verb == MotionVerb::tap) pressing_ = step.direction;
}

void MotionPlayer::put(const Coordinates& direction, double amount) {
  for (std::size_t i = 0; i < from_.size(); ++i) wish_.position[i] = from_[i] + direction[i] * amount;
}

bool MotionPlayer::go(const Coordinates& to, double duration_s) {
  const double s = duration_s > 0 ? std::min(t_ / duration_s, 1.0) : 1.0;
  for (std::size_t i = 0; i < from_.size(); ++i) wish_.position[i] = from_[i] + (to[i] - from_[i]) * minimum_jerk(s);
  return s >= 1;
}

bool MotionPlayer::play(const MotionStep& step, const Coordinates& hand, const Coordinates& efforts) {
  Coordinates to = from_;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += step.direction[i] * step.amount;
  const double omega = 2 * std::numbers::pi / step.period_s;
  switch (step.verb) {
    case MotionVerb::hold:
      return t_ >= step.duration_s;
    case MotionVerb::touch:
      return touch(step, efforts);
    case MotionVerb::press:
      put(pressing_, step.amount * minimum_jerk(std::min(t_ / kPressRise, 1.0)));
      return t_ >= std::max(step.duration_s, kPressRise);
    case MotionVerb::drag:
      return go(to, kMinimumJerkPeak * step.amount / step.speed);
    case MotionVerb::tap:
      return tap(step, efforts);
    case MotionVerb::sine:
      put(step.direction, step.amount * std::sin(omega * t_));
      return t_ >= step.duration_s;
    case MotionVerb::circle:
      put(step.direction, step.amount * (std::cos(omega * t_) - 1));
      for (std::size_t i = 0; i < from_.size(); ++i) {
        wish_.position[i] += step.sideways[i] * step.amount * std::sin(omega * t_);
      }
      return t_ >= step.duration_s;
    case MotionVerb::back:
      return go(start_, kMinimumJerkPeak * distance(from_, start_) / step.speed);
    case MotionVerb::letgo:
      wish_.position = hand;
      wish_.holding = t_ >= step.duration_s;
      return wish_.holding;
    case MotionVerb::button:
      if (step.on) wish_.buttons |= 1U << (step.button - 1);
      if (!step.on) wish_.buttons &= ~(1U << (step.button - 1));
      return true;
  }
  return true;
}

bool MotionPlayer::touch(const MotionStep& step, const Coordinates& efforts) {
  if (resistance(efforts, step.direction) >= step.threshold) return true;
  const double gone = std::min(step.speed * t_, step.amount);
  put(step.direction, gone);
  return gone >= step.amount;
}

// In a quarter of the period to the distance, or as far as something is felt, and back in the next one; then rest.
bool MotionPlayer::tap(const MotionStep& step, const Coordinates& efforts) {
  const double quarter = step.period_s / 4;
  const double total = step.period_s * step.times;
  if (t_ >= total) {
    wish_.position = from_;
    return true;
  }
  const double t = std::fmod(t_, step.period_s);
  if (t < quarter && turn_at_ < 0) {
    reached_ = step.amount * t / quarter;
    if (resistance(efforts, step.direction) >= step.threshold) turn_at_ = t;
  } else if (turn_at_ < 0 && t < 2 * quarter) {
    turn_at_ = quarter;
    reached_ = step.amount;
  }
  if (t >= 2 * quarter) turn_at_ = -1;
  const double back = turn_at_ < 0 ? (t < quarter ? 1.0 : 0.0) : std::max(0.0, 1 - (t - turn_at_) / quarter);
  put(step.direction, reached_ * back);
  return false;
}

}  // namespace cellmirror::sim
