#include "rt_core/haptics/nearest_point.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::haptics {

namespace {

constexpr double kLeastNormal = 1e-3;  // a shorter `a` belongs to a place that the tip hardly moves
constexpr double kTight = 1e-10;       // m, of a constraint's own: met
constexpr double kStillMet = 1e-6;     // m: what rounding may leave where planes are nearly parallel
constexpr double kLeastSine = 1e-10;   // squared, of the angle between two normals that count as different

// The constraints at the goal, reduced to numbers: what of each is left, and the products of their normals. x = goal +
// sum of lambda_i a_i has slack s_j + sum of G_ji lambda_i.
struct Reduced {
  std::uint8_t count = 0;
  std::array<std::uint8_t, kMaxConstraints> index{};
  std::array<double, kMaxConstraints> slack{};
  std::array<std::array<double, kMaxConstraints>, kMaxConstraints> gram{};
};

bool usable(const ContactConstraint& constraint) CELL_RT {
  const double square = constraint.a.squaredNorm();
  return std::isfinite(constraint.gap) && std::isfinite(square) && square >= kLeastNormal * kLeastNormal;
}

double slack_at(const ContactModel& model, const ContactConstraint& constraint, const Eigen::Vector3d& x) CELL_RT {
  return constraint.a.dot(x - model.x_ref) + constraint.gap;
}

std::size_t count_of(const ContactModel& model) CELL_RT { return std::min<std::size_t>(model.count, kMaxConstraints); }

Reduced reduce(const ContactModel& model, const Eigen::Vector3d& goal) CELL_RT {
  Reduced reduced;
  for (std::size_t i = 0; i < count_of(model); ++i) {
    const ContactConstraint& constraint = model.constraints[i];
    if (!usable(constraint)) continue;
    const std::size_t row = reduced.count++;
    reduced.index[row] = static_cast<std::uint8_t>(i);
    reduced.slack[row] = slack_at(model, constraint, goal);
    for (std::size_t j = 0; j <= row; ++j) {
      const double product = constraint.a.dot(model.constraints[reduced.index[j]].a);
      reduced.gram[row][j] = product;
      reduced.gram[j][row] = product;
    }
  }
  return reduced;
}

struct Candidate {
  std::array<std::uint8_t, kMaxActive> row{};
  std::array<double, kMaxActive> lambda{};
  std::uint8_t count = 0;
  double violation = std::numeric_limits<double>::infinity();
};

double violation_of(const Reduced& reduced, const Candidate& candidate) CELL_RT {
  double worst = 0;
  for (std::size_t j = 0; j < reduced.count; ++j) {
    double slack = reduced.slack[j];
    for (std::size_t k = 0; k < candidate.count; ++k) slack += reduced.gram[j][candidate.row[k]] * candidate.lambda[k];
    worst = std::max(worst, -slack);
  }
  return worst;
}

// True where the candidate is the answer; else the better of the two is kept. A candidate whose multipliers are all
// positive and that meets every constraint meets the conditions of Karush, Kuhn and Tucker, so it is the only answer.
bool settles(const Reduced& reduced, Candidate candidate, Candidate& best) CELL_RT {
  for (std::size_t k = 0; k < candidate.count; ++k) {
    if (!(candidate.lambda[k] > 0)) return false;
  }
  candidate.violation = violation_of(reduced, candidate);
  if (candidate.violation < best.violation) best = candidate;
  return candidate.violation <= kTight;
}

bool pair_settles(const Reduced& reduced, std::uint8_t i, std::uint8_t j, Candidate& best) CELL_RT {
  const auto& G = reduced.gram;
  const double determinant = G[i][i] * G[j][j] - G[i][j] * G[i][j];
  if (determinant <= kLeastSine * G[i][i] * G[j][j]) return false;
  const double si = reduced.slack[i];
  const double sj = reduced.slack[j];
  return settles(
      reduced, {{i, j}, {(G[i][j] * sj - G[j][j] * si) / determinant, (G[i][j] * si - G[i][i] * sj) / determinant}, 2},
      best);
}

bool triple_settles(const Reduced& reduced, std::uint8_t i, std::uint8_t j, std::uint8_t k, Candidate& best) CELL_RT {
  const auto& G = reduced.gram;
  const double c00 = G[j][j] * G[k][k] - G[j][k] * G[j][k];
  const double c01 = G[j][k] * G[i][k] - G[i][j] * G[k][k];
  const double c02 = G[i][j] * G[j][k] - G[j][j] * G[i][k];
  const double determinant = G[i][i] * c00 + G[i][j] * c01 + G[i][k] * c02;
  if (determinant <= kLeastSine * G[i][i] * G[j][j] * G[k][k]) return false;
  const double c11 = G[i][i] * G[k][k] - G[i][k] * G[i][k];
  const double c12 = G[i][j] * G[i][k] - G[i][i] * G[j][k];
  const double c22 = G[i][i] * G[j][j] - G[i][j] * G[i][j];
  const double si = reduced.slack[i];
  const double sj = reduced.slack[j];
  const double sk = reduced.slack[k];
  return settles(reduced,
                 {{i, j, k},
                  {-(c00 * si + c01 * sj + c02 * sk) / determinant, -(c01 * si + c11 * sj + c12 * sk) / determinant,
                   -(c02 * si + c12 * sj + c22 * sk) / determinant},
                  3},
                 best);
}

Candidate search(const Reduced& reduced) CELL_RT {
  Candidate best;
  if (settles(reduced, {}, best)) return best;
  const std::uint8_t n = reduced.count;
  for (std::uint8_t i = 0; i < n; ++i) {
    if (settles(reduced, {{i}, {-reduced.slack[i] / reduced.gram[i][i]}, 1}, best)) return best;
  }
  for (std::uint8_t i = 0; i < n; ++i) {
    for (std::uint8_t j = 0; j < i; ++j) {
      if (pair_settles(reduced, i, j, best)) return best;
    }
  }
  for (std::uint8_t i = 0; i < n; ++i) {
    for (std::uint8_t j = 0; j < i; ++j) {
      for (std::uint8_t k = 0; k < j; ++k) {
        if (triple_settles(reduced, i, j, k, best)) return best;
      }
    }
  }
  return best;
}

}  // namespace

NearestPoint nearest_point(const ContactModel& model, const Eigen::Vector3d& goal) CELL_RT {
  const Reduced reduced = reduce(model, goal);
  const Candidate best = search(reduced);
  NearestPoint point;
  point.x = goal;
  point.found = best.violation <= kStillMet;
  if (!point.found) return point;
  point.active_count = best.count;
  for (std::size_t k = 0; k < best.count; ++k) {
    point.active[k] = reduced.index[best.row[k]];
    point.multiplier[k] = best.lambda[k];
    point.x += best.lambda[k] * model.constraints[point.active[k]].a;
  }
  return point;
}

double violation(const ContactModel& model, const Eigen::Vector3d& x) CELL_RT {
  double worst = 0;
  for (std::size_t i = 0; i < count_of(model); ++i) {
    const ContactConstraint& constraint = model.constraints[i];
    if (usable(constraint)) worst = std::max(worst, -slack_at(model, constraint, x));
  }
  return worst;
}

Eigen::Vector3d HeldDirections::free_part(const Eigen::Vector3d& v) const CELL_RT {
  if (count == kMaxActive) return Eigen::Vector3d::Zero();
  Eigen::Vector3d rest = v;
  for (std::size_t k = 0; k < count; ++k) rest -= unit[k].dot(rest) * unit[k];
  return rest;
}

HeldDirections held_directions(const ContactModel& model, const NearestPoint& at) CELL_RT {
  constexpr double kLeastNew = 1e-4;  // of a normal that adds a direction
  HeldDirections held;
  for (std::size_t k = 0; k < at.active_count; ++k) {
    const Eigen::Vector3d unit = model.constraints[at.active[k]].a.normalized();
    const Eigen::Vector3d rest = held.free_part(unit);
    if (rest.norm() > kLeastNew) held.unit[held.count++] = rest.normalized();
  }
  return held;
}

}  // namespace cellmirror::haptics
