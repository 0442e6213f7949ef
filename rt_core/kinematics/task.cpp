#include "rt_core/kinematics/task.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace cellmirror::kinematics {

namespace {

// A direction counts as parallel or a motion as none below this (sine of the angle; m a rad or m).
constexpr double kPlanarSlack = 1e-6;

// Unit vector perpendicular to the unit vector `a`.
Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& a) CELL_RT {
  const Eigen::Vector3d helper = std::abs(a.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return a.cross(helper).normalized();
}

// The rotation vector that turns the unit vector `from` into `to` by the shortest way.
Eigen::Vector3d turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) CELL_RT {
  const Eigen::Vector3d cross = from.cross(to);
  const double sine = cross.norm();
  const double angle = std::atan2(sine, from.dot(to));
  if (sine > 0) return cross * (angle / sine);
  return from.dot(to) > 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(std::numbers::pi * perpendicular_to(from));
}

// Postures spread over the ranges, so that one that happens to be singular decides nothing.
std::array<JointValues, 3> probes(const Chain& chain) {
  std::array<JointValues, 3> postures{};
  postures.fill(chain.middle());
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const bool bounded = std::isfinite(chain.lower()[i]);
    const double width = bounded ? chain.upper()[i] - chain.lower()[i] : 2.0;
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    postures[1][i] += 0.21 * width * sign / (1.0 + 0.3 * static_cast<double>(i));
    postures[2][i] -= 0.17 * width / (1.0 + 0.2 * static_cast<double>(i));
  }
  return postures;
}

// What a snake-like boom can do: which coordinates of the base it moves, and about which axis all its joints turn.
struct Mobility {
  std::uint8_t position_axes = 0;
  bool planar = false;  // every rotation is about one direction
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
};

Mobility mobility_of(const Chain& chain) {
  Mobility mobility;
  bool first = true;
  bool parallel = true;
  for (const JointValues& q : probes(chain)) {
    Jacobian J;
    (void)forward(chain, {q.data(), chain.variable_count()}, J);
    for (Eigen::Index i = 0; i < J.cols(); ++i) {
      for (int row = 0; row < 3; ++row) {
        if (std::abs(J(row, i)) > kPlanarSlack) mobility.position_axes |= static_cast<std::uint8_t>(1U << row);
      }
      const Eigen::Vector3d w = J.block<3, 1>(3, i);
      if (w.norm() < kPlanarSlack) continue;
      if (first) mobility.axis = w.normalized();
      first = false;
      parallel = parallel && mobility.axis.cross(w.normalized()).norm() < kPlanarSlack;
    }
  }
  mobility.planar = parallel && !first;
  return mobility;
}

// The boom's classes: the position as far as the boom can move, then the heading, then an even bend. The heading is the
// first of the tool's approach, normal and sliding axes that lies in the plane in which the boom turns.
Task boom_task(const Chain& chain, std::uint8_t bent_joints) {
  const Mobility mobility = mobility_of(chain);
  Task task;
  task.position_axes = mobility.position_axes;
  task.orientation_required = false;
  task.secondary = Secondary::even_bend;
  task.bent_joints = bent_joints;
  if (!mobility.planar) return task;
  const JointValues middle = chain.middle();
  const Eigen::Matrix3d R = forward(chain, {middle.data(), chain.variable_count()}).linear();
  constexpr std::array kHeadings = {OrientationTask::approach, OrientationTask::normal, OrientationTask::sliding};
  constexpr std::array kColumns = {2, 0, 1};
  for (std::size_t i = 0; i < kHeadings.size(); ++i) {
    if (std::abs(R.col(kColumns[i]).dot(mobility.axis)) < kPlanarSlack) {
      task.orientation = kHeadings[i];
      break;
    }
  }
  return task;
}

constexpr std::uint8_t kX = 0b001;
constexpr std::uint8_t kY = 0b010;
constexpr std::uint8_t kZ = 0b100;

// Named positions, every orientation as near as possible (robots with PRRR or PPRRR structure).
Task positions(std::uint8_t axes) { return {.position_axes = axes, .orientation_required = false}; }
// Named positions and the named direction of the tool.
Task directed(std::uint8_t axes, OrientationTask direction) {
  return {.position_axes = axes, .orientation = direction};
}

}  // namespace

Task task_of(InverseClass inverse_class, const Chain& chain) {
  using enum InverseClass;
  using enum OrientationTask;
  switch (inverse_class) {
    case align_frame:
      return {};
    case align_pos:
      return {.orientation = free};
    case align_x_axis:
      return positions(kX);
    case align_y_axis:
      return positions(kY);
    case align_z_axis:
      return positions(kZ);
    case align_xy_axis:
      return positions(kX | kY);
    case align_yz_axis:
      return positions(kY | kZ);
    case align_xz_axis:
      return positions(kX | kZ);
    case align_n_axis:
      return directed(kX | kY | kZ, normal);
    case align_s_axis:
      return directed(kX | kY | kZ, sliding);
    case align_a_axis:
      return directed(kX | kY | kZ, approach);
    case align_xy_n_axis:
      return directed(kX | kY, normal);
    case align_xy_s_axis:
      return directed(kX | kY, sliding);
    case align_xy_a_axis:
      return directed(kX | kY, approach);
    case align_xz_n_axis:
      return directed(kX | kZ, normal);
    case align_xz_s_axis:
      return directed(kX | kZ, sliding);
    case align_xz_a_axis:
      return directed(kX | kZ, approach);
    case align_yz_n_axis:
      return directed(kY | kZ, normal);
    case align_yz_s_axis:
      return directed(kY | kZ, sliding);
    case align_yz_a_axis:
      return directed(kY | kZ, approach);
    case edith:
      return boom_task(chain, 0);
    case boom_3:
      return boom_task(chain, 3);
    case boom_4:
      return boom_task(chain, 4);
    case boom_5:
      return boom_task(chain, 5);
    case boom_6:
      return boom_task(chain, 6);
  }
  return {};
}

bool bends(const Chain& chain, const Task& task, std::size_t variable) CELL_RT {
  if (!chain.rotates(variable)) return false;
  if (task.bent_joints == 0) return true;
  std::size_t behind = 0;
  for (std::size_t i = variable + 1; i < chain.variable_count(); ++i) behind += chain.rotates(i) ? 1U : 0U;
  return behind < task.bent_joints;
}

Twist task_error(const Task& task, const Pose& X_BT, const Pose& X_BG) CELL_RT {
  Twist error = Twist::Zero();
  for (int row = 0; row < 3; ++row) {
    if ((task.position_axes >> row & 1) != 0) error[row] = X_BG.translation()[row] - X_BT.translation()[row];
  }
  switch (task.orientation) {
    case OrientationTask::free:
      break;
    case OrientationTask::full:
      error.tail<3>() = pose_error(X_BT, X_BG).tail<3>();
      break;
    case OrientationTask::normal:
      error.tail<3>() = turn_between(X_BT.linear().col(0), X_BG.linear().col(0));
      break;
    case OrientationTask::sliding:
      error.tail<3>() = turn_between(X_BT.linear().col(1), X_BG.linear().col(1));
      break;
    case OrientationTask::approach:
      error.tail<3>() = turn_between(X_BT.linear().col(2), X_BG.linear().col(2));
      break;
  }
  return error;
}

bool meets(const Task& task, const Twist& error, double tolerance) CELL_RT {
  const bool position = error.head<3>().cwiseAbs().maxCoeff() <= tolerance;
  const bool orientation = !task.orientation_required || error.tail<3>().cwiseAbs().maxCoeff() <= tolerance;
  return position && orientation && error.allFinite();
}

}  // namespace cellmirror::kinematics
