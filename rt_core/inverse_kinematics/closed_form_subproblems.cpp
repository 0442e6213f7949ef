#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

#include <algorithm>
#include <limits>

namespace cellmirror::inverse_kinematics::closed_form {

namespace {

// The angles at which cos^2 and sin^2 of the half angle from `phase` are as cosine_part : sine_part. A part below zero
// by no more than its slack counts as zero: the one angle at the border.
Turns from_half_angles(double cosine_part, double sine_part, double cosine_slack, double sine_slack,
                       const Turn& phase) {
  Turns turns;
  if (!(cosine_part >= -cosine_slack && sine_part >= -sine_slack)) return turns;
  const double sum = std::max(cosine_part, 0.0) + std::max(sine_part, 0.0);
  if (sum <= 0) return turns;
  if (sine_part <= 0 || cosine_part <= 0) {
    turns.count = 1;
    turns.turn[0] = sine_part <= 0 ? phase : Turn{-phase.c, -phase.s};
    return turns;
  }
  const Turn away{(cosine_part - sine_part) / sum, 2 * std::sqrt(cosine_part * sine_part) / sum};
  turns.count = 2;
  turns.turn = {phase * away, phase * away.inverse()};
  return turns;
}

// a0 + a1 c + b1 s + a2 cos 2x + b2 sin 2x
struct Wave {
  double a0 = 0, a1 = 0, b1 = 0, a2 = 0, b2 = 0;
  [[nodiscard]] double at(const Turn& t) const {
    return a0 + a1 * t.c + b1 * t.s + a2 * (t.c * t.c - t.s * t.s) + b2 * (2 * t.c * t.s);
  }
  [[nodiscard]] Wave derivative() const { return {0, b1, -a1, 2 * b2, -2 * a2}; }
};

// A zero of `wave` between low and high, where its signs differ: Newton's steps, halving where they leave the bracket.
double zero_between(const Wave& wave, double low, double high) {
  const Wave slope = wave.derivative();
  const bool rising = wave.at(Turn::of(low)) < 0;
  double x = 0.5 * (low + high);
  for (int i = 0; i < 60; ++i) {
    const Turn t = Turn::of(x);
    const double value = wave.at(t);
    if (value == 0) break;
    ((value < 0) == rising ? low : high) = x;
    double next = x - value / slope.at(t);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 4 * std::numeric_limits<double>::epsilon()) return next;
    x = next;
  }
  return x;
}

struct Zeros {
  std::array<double, 4> at{};
  std::size_t count = 0;
  void add(double x) {
    if (count < at.size()) at[count++] = x;
  }
};

// The zeros of a wave, which has at most four, and the extrema that miss zero by at most `slack`. Sampled finely enough
// that more than one extremum between two samples is an accident; a pair of zeros between two samples shows as a dip.
Zeros zeros_of(const Wave& wave, double slack) {
  constexpr std::size_t kSamples = 32;
  constexpr double kStep = 2 * std::numbers::pi / static_cast<double>(kSamples);
  std::array<double, kSamples + 2> f{};
  const Turn step = Turn::of(kStep);
  Turn t;
  for (std::size_t i = 0; i < kSamples; ++i, t = t * step) f[i] = wave.at(t);
  f[kSamples] = f[0];
  f[kSamples + 1] = f[1];
  Zeros zeros;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double x = kStep * static_cast<double>(i);
    if ((f[i] < 0) != (f[i + 1] < 0)) {
      zeros.add(zero_between(wave, x, x + kStep));
      continue;
    }
    // A dip around sample i + 1 that does not cross zero there.
    const double sign = f[i + 1] < 0 ? -1 : 1;
    if ((f[i + 1] < 0) != (f[i + 2] < 0) || sign * f[i + 1] > sign * f[i] || sign * f[i + 1] >= sign * f[i + 2])
      continue;
    const double dip = zero_between(wave.derivative(), x, x + 2 * kStep);
    const double value = sign * wave.at(Turn::of(dip));
    if (value < 0) {
      zeros.add(zero_between(wave, x, dip));
      zeros.add(zero_between(wave, dip, x + 2 * kStep));
    } else if (value <= slack) {
      zeros.add(dip);
    }
  }
  return zeros;
}

}  // namespace

bool turn_between(const Vector& h, const Vector& from, const Vector& to, double scale, Turn& turn) {
  const Vector a = across(h, from);
  const Vector b = across(h, to);
  const double least = kSingular * kSingular * scale * scale;
  const double aa = a.squaredNorm();
  const double bb = b.squaredNorm();
  if (!(aa > least && bb > least)) return false;
  const double length = std::sqrt(aa * bb);
  turn = {a.dot(b) / length, h.dot(a.cross(b)) / length};
  return true;
}

Turns solve_cosine(double a, double b, double k, double slack, double tiny) {
  Turns turns;
  const double amplitude = std::sqrt(a * a + b * b);
  if (amplitude < tiny) {
    turns.free = std::abs(k) <= slack;
    return turns;
  }
  const Turn phase{a / amplitude, b / amplitude};
  return from_half_angles(amplitude + k, amplitude - k, slack, slack, phase);
}

Turns second_turn(const Vector& k1, const Vector& k2, const Vector& p, const Vector& t, double slack) {
  const Circle circle = Circle::of({k2, Vector::Zero()}, p);
  const double a = k1.dot(circle.cosine);
  const double b = k1.dot(circle.sine);
  const double radius = p.norm();
  const double amplitude = std::sqrt(a * a + b * b);
  Turns turns;
  if (!(amplitude > kSingular * radius)) {
    turns.free = std::abs(k1.dot(t - circle.center)) <= slack + kSingular * radius;
    return turns;
  }
  // With the highest and the lowest point of the circle over k1: twice the radius times (height of the highest point -
  // height of t), each height taken from the pole so that nothing cancels near it.
  const Turn phase{a / amplitude, b / amplitude};
  const Vector pole = radius * k1;
  const Vector arm = phase.c * circle.cosine + phase.s * circle.sine;
  const double sine_part = (t - pole).squaredNorm() - (circle.center + arm - pole).squaredNorm();
  const double cosine_part = (t + pole).squaredNorm() - (circle.center - arm + pole).squaredNorm();
  return from_half_angles(cosine_part, sine_part, 2 * radius * slack, 2 * radius * slack, phase);
}

Turns turn_to_distance(const Vector& h, const Circle& circle, const Vector& point, double distance_squared,
                       double slack) {
  const Vector m = across(h, circle.center - point);
  const double a = m.dot(circle.cosine);
  const double b = m.dot(circle.sine);
  const double far = m.norm() + circle.cosine.norm();
  const double near = std::abs(m.norm() - circle.cosine.norm());
  const double amplitude = std::sqrt(a * a + b * b);
  if (!(amplitude > kSingular * kSingular * far * far)) {
    Turns turns;
    turns.free = distance_squared <= (far + slack) * (far + slack) && std::sqrt(distance_squared) + slack >= near;
    return turns;
  }
  return from_half_angles(distance_squared - near * near, far * far - distance_squared, (2 * near + slack) * slack,
                          (2 * far + slack) * slack, {a / amplitude, b / amplitude});
}

TurnPairs solve_pair(const Eigen::Matrix2d& A, const Eigen::Matrix2d& B_inverse, const Eigen::Vector2d& k,
                     double slack) {
  // The second turn is g - G x with x the first as (c, s); that it lies on the unit circle is a wave of x.
  const Eigen::Matrix2d G = B_inverse * A;
  const Eigen::Vector2d g = B_inverse * k;
  const Eigen::Matrix2d M = G.transpose() * G;
  const Eigen::Vector2d linear = -2 * (G.transpose() * g);
  const Wave wave{g.squaredNorm() - 1 + 0.5 * (M(0, 0) + M(1, 1)), linear.x(), linear.y(), 0.5 * (M(0, 0) - M(1, 1)),
                  M(0, 1)};
  const Zeros zeros = zeros_of(wave, slack);
  TurnPairs pairs;
  for (std::size_t i = 0; i < zeros.count; ++i) {
    const Turn x = Turn::of(zeros.at[i]);
    const Eigen::Vector2d y = (g - G * Eigen::Vector2d(x.c, x.s)).normalized();
    pairs.first[pairs.count] = x;
    pairs.second[pairs.count++] = {y.x(), y.y()};
  }
  return pairs;
}

}  // namespace cellmirror::inverse_kinematics::closed_form
