#include "rt_core/inverse_kinematics/closed_form_pair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace cellmirror::inverse_kinematics::closed_form {

namespace {

// a0 + a1 cos x + b1 sin x + a2 cos 2x + b2 sin 2x
struct Wave {
  double a0 = 0, a1 = 0, b1 = 0, a2 = 0, b2 = 0;
  [[nodiscard]] double at(const Turn& x) const {
    return a0 + a1 * x.c + b1 * x.s + a2 * (x.c * x.c - x.s * x.s) + b2 * (2 * x.c * x.s);
  }
  // The wave of x - origin.
  [[nodiscard]] Wave from(const Turn& origin) const {
    const Turn twice = origin * origin;
    return {a0, a1 * origin.c + b1 * origin.s, b1 * origin.c - a1 * origin.s, a2 * twice.c + b2 * twice.s,
            b2 * twice.c - a2 * twice.s};
  }
};

constexpr std::size_t kDegree = 4;
using Polynomial = std::array<double, kDegree + 1>;  // constant first

double value_of(const Polynomial& p, std::size_t degree, double t) {
  double value = p[degree];
  for (std::size_t i = degree; i-- > 0;) value = value * t + p[i];
  return value;
}

Polynomial derivative_of(const Polynomial& p, std::size_t degree) {
  Polynomial d{};
  for (std::size_t i = 1; i <= degree; ++i) d[i - 1] = static_cast<double>(i) * p[i];
  return d;
}

// The zero of a polynomial between two places where its signs differ: Newton's steps, halving where they leave the
// bracket or come in slowly.
double zero_between(const Polynomial& p, std::size_t degree, double low, double high) {
  const bool rising = value_of(p, degree, low) < 0;
  double t = 0.5 * (low + high);
  double last_step = high - low;
  for (int i = 0; i < 100; ++i) {
    double value = p[degree];
    double slope = 0;
    for (std::size_t k = degree; k-- > 0;) {
      slope = slope * t + value;
      value = value * t + p[k];
    }
    if (value == 0) return t;
    ((value < 0) == rising ? low : high) = t;
    double next = t - value / slope;
    if (!(next > low && next < high) || std::abs(next - t) > 0.5 * std::abs(last_step)) next = 0.5 * (low + high);
    last_step = next - t;
    if (std::abs(last_step) <= 2 * std::numeric_limits<double>::epsilon() * std::abs(next)) return next;
    t = next;
  }
  return t;
}

struct Zeros {
  std::array<double, kDegree> at{};
  std::size_t count = 0;
};

// The zeros of p in [-bound, bound], ascending, given those of its derivative, between which it is monotone. A zero
// that only touches is left out.
Zeros zeros_between(const Polynomial& p, std::size_t degree, const Zeros& extrema, double bound) {
  Zeros zeros;
  double low = -bound;
  double at_low = value_of(p, degree, low);
  for (std::size_t i = 0; i <= extrema.count && zeros.count < degree; ++i) {
    const double high = i < extrema.count ? extrema.at[i] : bound;
    const double at_high = value_of(p, degree, high);
    if ((at_low < 0) != (at_high < 0)) zeros.at[zeros.count++] = zero_between(p, degree, low, high);
    low = high;
    at_low = at_high;
  }
  return zeros;
}

// (1 + t^2)^2 times the wave, t the tangent of the half angle.
Polynomial quartic_of(const Wave& w) {
  return {w.a0 + w.a1 + w.a2, 2 * w.b1 + 4 * w.b2, 2 * w.a0 - 6 * w.a2, 2 * w.b1 - 4 * w.b2, w.a0 - w.a1 + w.a2};
}

Turn turn_of_half_tangent(double t) {
  const double n = 1 / (1 + t * t);
  return {(1 - t * t) * n, 2 * t * n};
}

// Half a turn away from where the wave is largest of eight places, so that no zero has an infinite half tangent.
Turn origin_for(const Wave& wave) {
  constexpr double kR = std::numbers::sqrt2 / 2;
  constexpr std::array<Turn, 8> kPlaces{{{1, 0}, {kR, kR}, {0, 1}, {-kR, kR}, {-1, 0}, {-kR, -kR}, {0, -1}, {kR, -kR}}};
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const double size = std::abs(wave.at(kPlaces[i]));
    if (size > most) {
      most = size;
      best = i;
    }
  }
  return {-kPlaces[best].c, -kPlaces[best].s};
}

struct Angles {
  std::array<Turn, kDegree> turn;
  std::size_t count = 0;
  void add(const Turn& t) {
    if (count < turn.size()) turn[count++] = t;
  }
};

// Where the wave is zero, and where it turns back at most `slack` before zero.
Angles zeros_of(const Wave& wave, double slack) {
  const Turn origin = origin_for(wave);
  const Polynomial p = quartic_of(wave.from(origin));
  Angles angles;
  double bound = 0;
  for (std::size_t i = 0; i < kDegree; ++i) bound = std::max(bound, std::abs(p[i]));
  bound = 1 + bound / std::abs(p[kDegree]);  // Cauchy's bound; those of the derivatives' zeros within are less
  if (!std::isfinite(bound)) return angles;
  std::array<Polynomial, kDegree> derivative;
  derivative[0] = p;
  for (std::size_t i = 1; i < kDegree; ++i) derivative[i] = derivative_of(derivative[i - 1], kDegree + 1 - i);
  Zeros extrema;
  for (std::size_t i = kDegree - 1; i > 0; --i) extrema = zeros_between(derivative[i], kDegree - i, extrema, bound);
  const Zeros zeros = zeros_between(p, kDegree, extrema, bound);
  for (std::size_t i = 0; i < zeros.count; ++i) angles.add(origin * turn_of_half_tangent(zeros.at[i]));
  for (std::size_t i = 0; i < extrema.count; ++i) {
    const double t = extrema.at[i];
    // With a zero on neither side (each extremum has a zero between it and the next one, or none).
    const Turn turn = origin * turn_of_half_tangent(t);
    const double curvature = value_of(derivative[2], kDegree - 2, t);
    if (std::abs(wave.at(turn)) <= slack && (value_of(p, kDegree, t) > 0) == (curvature > 0)) angles.add(turn);
  }
  return angles;
}

}  // namespace

TurnPairs solve_pair(const Eigen::Matrix2d& A, const Eigen::Matrix2d& inverse, const Eigen::Vector2d& k, double slack) {
  // The second turn is g - G x with x the first as (c, s); that it lies on the unit circle is a wave of x.
  const Eigen::Matrix2d G = inverse * A;
  const Eigen::Vector2d g = inverse * k;
  const Eigen::Matrix2d M = G.transpose() * G;
  const Eigen::Vector2d linear = -2 * (G.transpose() * g);
  const Wave wave{g.squaredNorm() - 1 + 0.5 * (M(0, 0) + M(1, 1)), linear.x(), linear.y(), 0.5 * (M(0, 0) - M(1, 1)),
                  M(0, 1)};
  const Angles first = zeros_of(wave, slack);
  TurnPairs pairs;
  for (std::size_t i = 0; i < first.count; ++i) {
    const Turn& x = first.turn[i];
    const Eigen::Vector2d y = g - G * Eigen::Vector2d(x.c, x.s);
    const double length = y.norm();
    if (!(length > 0)) continue;
    pairs.first[pairs.count] = x;
    pairs.second[pairs.count++] = {y.x() / length, y.y() / length};
  }
  return pairs;
}

}  // namespace cellmirror::inverse_kinematics::closed_form
