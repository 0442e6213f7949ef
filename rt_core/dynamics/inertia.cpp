#include "rt_core/dynamics/inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace cellmirror::dynamics {

namespace {

// Steiner's theorem: the moments that a point mass at `p` adds.
Eigen::Matrix3d point_moments(double mass, const Eigen::Vector3d& p) {
  return mass * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
}

}  // namespace

Inertia moved(const Inertia& inertia, const Pose& X_AB) {
  const Eigen::Matrix3d R_AB = X_AB.linear();
  return {inertia.mass, X_AB * inertia.p_C, R_AB * inertia.I_C * R_AB.transpose()};
}

Inertia joined(const Inertia& a, const Inertia& b) {
  Inertia both;
  both.mass = a.mass + b.mass;
  both.I_C = a.I_C + b.I_C;
  if (both.mass <= 0.0) return both;
  both.p_C = (a.mass * a.p_C + b.mass * b.p_C) / both.mass;
  both.I_C += point_moments(a.mass, a.p_C - both.p_C) + point_moments(b.mass, b.p_C - both.p_C);
  return both;
}

bool is_empty(const Inertia& inertia) { return inertia.mass == 0.0 && inertia.I_C.isZero(0.0); }

Result<void> check(const Inertia& inertia) {
  if (!std::isfinite(inertia.mass) || !inertia.p_C.allFinite() || !inertia.I_C.allFinite()) {
    return fail("a mass, its centre or its moments are not finite");
  }
  if (inertia.mass < 0.0) return fail(fmt::format("a mass of {} kg is negative", inertia.mass));
  const double scale = inertia.I_C.cwiseAbs().maxCoeff();
  constexpr double kRounding = 1e-9;  // of numbers with ten digits, as files give them
  if ((inertia.I_C - inertia.I_C.transpose()).cwiseAbs().maxCoeff() > kRounding * scale) {
    return fail("the moments of inertia are not symmetric");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia.I_C, Eigen::EigenvaluesOnly);
  if (axes.eigenvalues().minCoeff() < -kRounding * scale) {
    return fail("a principal moment of inertia is negative", "check the products of inertia and their signs");
  }
  return {};
}

}  // namespace cellmirror::dynamics
