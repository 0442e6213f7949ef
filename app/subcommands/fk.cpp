// cellmirror fk: where the tip is at given joint values.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/kinematics/robot_choice.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "rt_core/base/units.hpp"
#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

struct FkOptions {
  RobotChoice robot;
  std::string joints;
  bool jacobian = false;
  bool json = false;
};

struct Tip {
  Pose X_BT;
  Eigen::Quaterniond q_BT;  // with w not negative
  Eigen::Vector3d rpy;
  kinematics::Jacobian jacobian;
};

Tip tip_at(const kinematics::Chain& chain, std::span<const double> q) {
  Tip out;
  out.X_BT = kinematics::forward(chain, q, out.jacobian);
  out.q_BT = Eigen::Quaterniond(out.X_BT.linear()).normalized();
  if (out.q_BT.w() < 0.0) out.q_BT.coeffs() = -out.q_BT.coeffs();
  out.rpy = rpy_from_rotation(out.X_BT.linear());
  return out;
}

template <class Matrix>
json rows_of(const Matrix& matrix) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

void print_json(const FkOptions& options, const ChosenRobot& robot, const std::vector<double>& q, const Tip& tip) {
  json names = json::array();
  for (const kinematics::Variable& variable : robot.chain.variables()) names.push_back(variable.name);
  const Eigen::Vector3d p = tip.X_BT.translation();
  json document = {{"robot", robot.name},
                   {"base", robot.base},
                   {"tip", robot.tip},
                   {"joint_names", std::move(names)},
                   {"joints", q},
                   {"within_limits", beyond_limits(robot.chain, q).empty()},
                   {"position_m", {p.x(), p.y(), p.z()}},
                   {"quaternion_xyzw", {tip.q_BT.x(), tip.q_BT.y(), tip.q_BT.z(), tip.q_BT.w()}},
                   {"rpy_rad", {tip.rpy.x(), tip.rpy.y(), tip.rpy.z()}},
                   {"matrix", rows_of(tip.X_BT.matrix())}};
  if (options.jacobian) document["jacobian"] = rows_of(tip.jacobian);
  std::printf("%s\n", document.dump(-1, ' ', false, json::error_handler_t::replace).c_str());
}

// As it is printed with six decimals: without the sign of a zero.
double shown(double value) { return std::abs(value) < 5e-7 ? 0.0 : value; }

void print_text(const FkOptions& options, const ChosenRobot& robot, const Tip& tip) {
  const Eigen::Vector3d p = tip.X_BT.translation();
  fmt::print("{} in {}\n", robot.tip, robot.base);
  fmt::print("position    {:12.6f} {:12.6f} {:12.6f}  m\n", shown(p.x()), shown(p.y()), shown(p.z()));
  fmt::print("quaternion  {:12.6f} {:12.6f} {:12.6f} {:12.6f}  x y z w\n", shown(tip.q_BT.x()), shown(tip.q_BT.y()),
             shown(tip.q_BT.z()), shown(tip.q_BT.w()));
  const Eigen::Vector3d degrees = tip.rpy / kRadPerDeg;
  fmt::print("rpy         {:12.6f} {:12.6f} {:12.6f}  deg\n", shown(degrees.x()), shown(degrees.y()),
             shown(degrees.z()));
  if (!options.jacobian) return;
  fmt::print("\njacobian    (rows: velocity x y z, angular velocity x y z, in {}; a column a joint)\n", robot.base);
  for (Eigen::Index i = 0; i < tip.jacobian.rows(); ++i) {
    fmt::print("           ");
    for (Eigen::Index j = 0; j < tip.jacobian.cols(); ++j) fmt::print(" {:12.6f}", shown(tip.jacobian(i, j)));
    fmt::print("\n");
  }
}

int show(const FkOptions& options) {
  Diagnostics diagnostics;
  const auto robot = choose_robot(options.robot, diagnostics);
  if (!robot) {
    std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
    return kExitRefused;
  }
  const auto q = parse_joints(options.joints, "--joints", robot->chain);
  if (!q) return refuse(q.error().text());
  if (const std::string beyond = beyond_limits(robot->chain, *q); !beyond.empty())
    std::fprintf(stderr, "cellmirror: %s\n", beyond.c_str());
  const Tip tip = tip_at(robot->chain, *q);
  if (options.json) {
    print_json(options, *robot, *q, tip);
  } else {
    print_text(options, *robot, tip);
  }
  return kExitDone;
}

}  // namespace

void add_fk(cli::Command program, Action& action) {
  auto options = std::make_shared<FkOptions>();
  cli::Command sub = program.subcommand("fk", "Compute where the tip is at given joint values (forward kinematics)");
  add_robot_options(sub, options->robot);
  sub.option("--joints", options->joints, "'q1 q2 ...': one value per joint, rad or m").required();
  sub.flag("--jacobian", options->jacobian, "the Jacobian too");
  sub.flag("--json", options->json, "one JSON document (docs/kinematics.md)");
  sub.footer("Example: cellmirror fk --urdf arm.urdf --base base_link --tip tool0 --joints '0 0.5 1 0 0.5 0'");
  sub.when_named([options, &action] { action = [options] { return show(*options); }; },
                 [options] { return misuse(options->robot); });
}

}  // namespace cellmirror::app
