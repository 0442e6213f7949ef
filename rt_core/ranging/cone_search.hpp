// Searches along one variable for the nearest point within a cone, where there is no closed form. Private to this
// folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "rt_core/ranging/cone_section.hpp"

namespace cellmirror::ranging {

// How good a value of the variable is: first by how far everything there is from being allowed (0: something is), then
// by distance. Of things allowed the nearest counts, of things that are not those that point the way.
struct Rank {
  double violation = 0;
  double distance = 0;
  [[nodiscard]] bool operator<(const Rank& other) const {
    return violation != other.violation ? violation < other.violation : distance < other.distance;
  }
};

// The segment's part in the cone: the nearest point of it, or else how far the segment is beyond the cone. Both are
// what a convex function leaves after minimizing along the segment, so for parallel segments across a convex body they
// have one valley.
[[nodiscard]] inline Rank rank_of_segment(const ConeShape& cone, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                          Eigen::Vector3d& p);

// Golden section on a function with one valley in [low, high]; `rank` keeps what it meets. To 1e-12 of the interval.
template <typename Rank_of>
void golden_section(double low, double high, const Rank_of& rank_of) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 58;
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  Rank at_left = rank_of(left);
  Rank at_right = rank_of(right);
  for (int i = 0; i < kSteps; ++i) {
    if (at_right < at_left) {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = rank_of(right);
    } else {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = rank_of(left);
    }
  }
}

// On a circle (0 to 2 pi) with any number of valleys that are wider than a 128th of it.
template <typename Rank_of>
void all_around(const Rank_of& rank_of) {
  constexpr std::size_t kSamples = 128;
  constexpr double kStep = 2.0 * 3.14159265358979323846 / kSamples;
  std::array<Rank, kSamples> ranks;
  for (std::size_t i = 0; i < kSamples; ++i) ranks[i] = rank_of(kStep * static_cast<double>(i));
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Rank& before = ranks[(i + kSamples - 1) % kSamples];
    const Rank& after = ranks[(i + 1) % kSamples];
    if (before < ranks[i] || after < ranks[i]) continue;
    const double at = kStep * static_cast<double>(i);
    golden_section(at - kStep, at + kStep, rank_of);
  }
}

// The least that a point of the segment is beyond the cone's surface, m (ConeShape::beyond).
[[nodiscard]] inline double least_beyond(const ConeShape& cone, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d D = b - a;
  const double A = D.x() * D.x() + D.y() * D.y();
  const double B = D.x() * a.x() + D.y() * a.y();
  const double g = cone.sine / cone.cosine * D.z();
  double t = g > 0.0 ? 1.0 : 0.0;
  if (A > g * g) {
    const double across = (D.x() * a.y() - D.y() * a.x()) / A;  // of the line from the cone's axis, by sqrt(A)
    t = g * std::abs(across) / std::sqrt(A - g * g) - B / A;
  }
  return cone.beyond(a + std::fmin(std::fmax(t, 0.0), 1.0) * D);
}

inline Rank rank_of_segment(const ConeShape& cone, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            Eigen::Vector3d& p) {
  constexpr double kAnywhere = 1e150;  // its square is a number
  if (nearest_on_segment(cone, a, b, kAnywhere, p)) return {0.0, p.norm()};
  constexpr double kLeast = 1e-300;
  return {std::fmax(least_beyond(cone, a, b), kLeast), 0.0};
}

}  // namespace cellmirror::ranging
