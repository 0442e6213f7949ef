#include "rt_core/inverse_kinematics/closed_form_geometry.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace cellmirror::inverse_kinematics::closed_form {

double sine_between(const Line& a, const Line& b) { return a.h.cross(b.h).norm(); }

std::optional<Meeting> meeting(std::span<const Line> lines) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vector right = Vector::Zero();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && sine_between(lines[i - 1], lines[i]) < kLeastSine) return std::nullopt;
    const Eigen::Matrix3d projector = Eigen::Matrix3d::Identity() - lines[i].h * lines[i].h.transpose();
    sum += projector;
    right += projector * lines[i].o;
  }
  Meeting result;
  result.point = sum.inverse() * right;
  for (const Line& line : lines) {
    result.distance = std::max(result.distance, across(line.h, result.point - line.o).norm());
  }
  return result;
}

double make_parallel(std::span<Line> lines) {
  Vector mean = Vector::Zero();
  for (const Line& line : lines) mean += line.h.dot(lines[0].h) < 0 ? Vector(-line.h) : line.h;
  mean.normalize();
  double worst = 0;
  for (Line& line : lines) {
    worst = std::max(worst, line.h.cross(mean).norm());
    line.h = line.h.dot(mean) < 0 ? Vector(-mean) : mean;
  }
  return worst;
}

Vector side_of(const Vector& h) {
  Eigen::Index least = 0;
  h.cwiseAbs().minCoeff(&least);
  return across(h, Vector::Unit(least)).normalized();
}

}  // namespace cellmirror::inverse_kinematics::closed_form
