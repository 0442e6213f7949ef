#include "rt_core/kinematics/descent.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::kinematics {

namespace {

double half_square(const Six& e) CELL_RT {
  double sum = 0;
  for (const double component : e) sum += component * component;
  return 0.5 * sum;
}

// The axis of the tool that a vector task turns, as a column of the rotation.
Eigen::Index axis_of(OrientationTask orientation) CELL_RT {
  if (orientation == OrientationTask::normal) return 0;
  return orientation == OrientationTask::sliding ? 1 : 2;
}

// angle / sin(angle) of an angle within [0, pi).
double turn_per_sine(double sine, double cosine) CELL_RT {
  constexpr double kSmall = 1e-2;
  if (cosine > 0 && sine < kSmall) {
    const double s2 = sine * sine;
    return 1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0));
  }
  return std::atan2(sine, cosine) / sine;
}

// As pose_error(), without the detour over a quaternion unless the turn is nearly half a one.
Eigen::Vector3d rotation_between(const Pose& X_BT, const Pose& X_BG) CELL_RT {
  constexpr double kNearlyHalf = -0.99;
  const auto& T = X_BT.matrix();
  const auto& G = X_BG.matrix();
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  double trace = 0;
  for (Eigen::Index c = 0; c < 3; ++c) {
    w.x() += T(1, c) * G(2, c) - T(2, c) * G(1, c);
    w.y() += T(2, c) * G(0, c) - T(0, c) * G(2, c);
    w.z() += T(0, c) * G(1, c) - T(1, c) * G(0, c);
    trace += T(0, c) * G(0, c) + T(1, c) * G(1, c) + T(2, c) * G(2, c);
  }
  const double cosine = 0.5 * (trace - 1.0);
  if (cosine < kNearlyHalf) return pose_error(X_BT, X_BG).tail<3>();
  w *= 0.5;
  return w * turn_per_sine(w.norm(), cosine);
}

}  // namespace

Descent::Descent(const Chain& chain, const Task& task, const Pose& X_BG) CELL_RT : chain_(chain),
                                                                                   task_(task),
                                                                                   X_BG_(X_BG),
                                                                                   length_(unit_of_length(chain)) {}

void Descent::orient(const Pose& X_BT, double weight, Linearised& at) const CELL_RT {
  const bool full = task_.orientation == OrientationTask::full;
  const Eigen::Vector3d w = full ? rotation_between(X_BT, X_BG_) : task_error(task_, X_BT, X_BG_).tail<3>();
  for (std::size_t k = 0; k < 3; ++k) at.e[3 + k] = weight * w[static_cast<Eigen::Index>(k)];
  if (full) return;
  const Eigen::Vector3d tool = X_BT.linear().col(axis_of(task_.orientation));
  for (std::size_t i = 0; i < at.variables; ++i) {  // turning about the tool's own axis is free
    Six& column = at.column[i];
    const double along = column[3] * tool[0] + column[4] * tool[1] + column[5] * tool[2];
    for (std::size_t k = 0; k < 3; ++k) column[3 + k] -= along * tool[static_cast<Eigen::Index>(k)];
  }
}

void Descent::linearise(std::span<const double> q, double orientation_weight, Linearised& at) CELL_RT {
  const Pose X_BT = forward(chain_, q, jacobian_);
  const double per_length = 1.0 / length_;
  const double weight = task_.orientation == OrientationTask::free ? 0.0 : orientation_weight;
  std::array<double, 3> row{};
  at.e.fill(0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    row[k] = (task_.position_axes >> k & 1) != 0 ? per_length : 0.0;
    const auto axis = static_cast<Eigen::Index>(k);
    at.e[k] = row[k] * (X_BG_.translation()[axis] - X_BT.translation()[axis]);
  }
  at.variables = chain_.variable_count();
  const double* from = jacobian_.data();
  for (std::size_t i = 0; i < at.variables; ++i, from += 6) {
    const double unit = chain_.rotates(i) ? 1.0 : length_;
    Six& column = at.column[i];
    for (std::size_t k = 0; k < 3; ++k) {
      column[k] = unit * row[k] * from[k];
      column[3 + k] = unit * weight * from[3 + k];
    }
  }
  if (weight > 0) orient(X_BT, weight, at);
}

Room Descent::room_at(std::span<const double> q) const CELL_RT {
  Room room;
  const double per_length = 1.0 / length_;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double unit = chain_.rotates(i) ? 1.0 : per_length;
    room.below[i] = unit * (chain_.lower()[i] - q[i]);
    room.above[i] = unit * (chain_.upper()[i] - q[i]);
  }
  return room;
}

bool Descent::within(const Six& e, double orientation_weight, double tolerance) const CELL_RT {
  const double position = tolerance / length_;
  const double orientation = tolerance * orientation_weight;  // weight 0: e is zero
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(e[k]) <= position && std::abs(e[3 + k]) <= orientation)) return false;
  }
  return true;
}

DescentResult Descent::meet(std::span<double> q, const DescentOptions& options) CELL_RT {
  const bool attempted = !task_.orientation_required && task_.orientation != OrientationTask::free;
  return attempted ? meet_in_stages(q, options) : run(q, 1.0, options);
}

// The orientation's weight goes down in stages, so that each begins near its end, and the last stage meets what is
// required by the smallest correction.
DescentResult Descent::meet_in_stages(std::span<double> q, const DescentOptions& options) CELL_RT {
  constexpr std::array kWeights = {1.0, 0.1, 0.01, 0.0};
  constexpr double kStageEnds = 1e-4;  // rad, units of length
  constexpr int kCorrections = 8;
  DescentResult all;
  for (const double weight : kWeights) {
    DescentOptions stage_options = options;
    if (weight > 0) {
      stage_options.max_iterations -= all.iterations;
      stage_options.smallest_step = kStageEnds;
    } else {
      stage_options.max_iterations = std::max(options.max_iterations - all.iterations, kCorrections);
    }
    const DescentResult stage = run(q, weight, stage_options);
    all.iterations += stage.iterations;
    all.met = stage.met;
    if (stage.met) break;
  }
  return all;
}

DescentResult Descent::run(std::span<double> q, double orientation_weight, const DescentOptions& options) CELL_RT {
  // Damping proportional to the squared error keeps steps short far away and lets singular targets converge (Sugihara,
  // Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, IEEE T-RO 27(5), 2011); the factor
  // follows the gain as in Levenberg and Marquardt's method. The values were measured on all arms of the benchmark.
  constexpr double kFloor = 1e-13;
  constexpr double kFirstFactor = 0.1;
  constexpr double kLeastFactor = 1e-4;
  constexpr double kMostFactor = 1e6;
  constexpr double kLeastGain = 1e-3;  // of the error; a step that gains less counts as standing still
  constexpr int kStandstills = 3;
  constexpr double kNoStep = 1e-12;

  DescentResult result;
  Linearised at;
  Linearised next;
  std::array<double, kMaxVariables> dq{};
  std::array<double, kMaxVariables> candidate{};
  linearise(q, orientation_weight, at);
  double cost = half_square(at.e);
  double factor = kFirstFactor;
  int still = 0;
  while (!(result.met = within(at.e, orientation_weight, options.tolerance)) &&
         result.iterations < options.max_iterations && still < kStandstills) {
    ++result.iterations;
    const double largest = box_step(at, room_at(q), factor * cost + kFloor, dq);
    if (!(largest > kNoStep)) break;
    for (std::size_t i = 0; i < q.size(); ++i) {
      candidate[i] = std::clamp(q[i] + unscaled(i, dq[i]), chain_.lower()[i], chain_.upper()[i]);
    }
    linearise({candidate.data(), q.size()}, orientation_weight, next);
    const double next_cost = half_square(next.e);
    if (!(next_cost < cost)) {
      factor = std::min(10.0 * factor, kMostFactor);
      ++still;
      continue;
    }
    still = cost - next_cost < kLeastGain * cost ? still + 1 : 0;
    std::copy_n(candidate.begin(), q.size(), q.begin());
    at = next;
    cost = next_cost;
    factor = std::max(0.2 * factor, kLeastFactor);
    if (largest < options.smallest_step) break;
  }
  return result;
}

}  // namespace cellmirror::kinematics
