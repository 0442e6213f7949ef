// The robot that `fk` and `ik` work on: links of a URDF or component file, or a robot of a cell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::cli {
class Command;
}

namespace cellmirror::app {

// As the command line gives it: a file with base and tip, or a cell with a robot.
struct RobotChoice {
  std::string file;
  std::string base;
  std::string tip;
  std::string cell;
  std::string robot;
};

struct ChosenRobot {
  std::string name;
  std::string base;
  std::string tip;
  kinematics::Chain chain;
  InverseClass inverse_class = InverseClass::align_frame;  // what the robot is set to
};

// --urdf, --base, --tip, --cell, --robot.
void add_robot_options(cli::Command sub, RobotChoice& choice);

// What is missing or contradicts itself, as one sentence; empty: nothing. Wrong usage.
[[nodiscard]] std::string misuse(const RobotChoice& choice);

// Nothing, and all diagnostics, where a file is wrong or the chain cannot be made.
[[nodiscard]] std::optional<ChosenRobot> choose_robot(const RobotChoice& choice, Diagnostics& diagnostics);

// One value a joint, separated by blanks or commas. Refused: another count than the chain has, what is no finite
// number. `option` names it in the message.
[[nodiscard]] Result<std::vector<double>> parse_joints(const std::string& text, const std::string& option,
                                                       const kinematics::Chain& chain);

// "J_1 = 3.2 is beyond -2.967..2.967 rad", a sentence for each joint that is; empty: none.
[[nodiscard]] std::string beyond_limits(const kinematics::Chain& chain, std::span<const double> q);

}  // namespace cellmirror::app
