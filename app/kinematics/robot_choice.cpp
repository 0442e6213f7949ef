#include "app/kinematics/robot_choice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "config/cell_file.hpp"
#include "config/command_line/command_line.hpp"
#include "config/parse.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/cell/robot_chain.hpp"

namespace cellmirror::app {

namespace {

// "FILE:12: what" with its place where diagnostics have it.
void add_finding(Diagnostics& diagnostics, const std::string& file, const Error& error) {
  Place place{file};
  std::string_view what = error.what;
  if (what.starts_with(file + ":")) {
    what.remove_prefix(file.size() + 1);
    const std::size_t digits = std::min(what.find_first_not_of("0123456789"), what.size());
    if (const auto line = parse_integer(what.substr(0, digits)); line && what.substr(digits).starts_with(':')) {
      place.line = static_cast<int>(*line);
      what.remove_prefix(digits + 1);
    }
  }
  diagnostics.error(std::move(place), std::string(trimmed(what)), error.remedy);
}

std::optional<ChosenRobot> robot_of_cell(const RobotChoice& choice, Diagnostics& diagnostics) {
  const auto cell = load_cell(choice.cell, diagnostics);
  if (!cell) return std::nullopt;
  auto chain = robot_chain(cell->cell, choice.robot);
  if (!chain) {
    diagnostics.error({choice.cell}, chain.error().what, chain.error().remedy);
    return std::nullopt;
  }
  return ChosenRobot{choice.robot, "ZP", "TCP", std::move(chain->chain),
                     cell->cell.robot(choice.robot)->parameters().inverse_class};
}

std::optional<ChosenRobot> robot_of_file(const RobotChoice& choice, Diagnostics& diagnostics) {
  const auto text = read_text_file(choice.file, kLargestText);
  if (!text) {
    diagnostics.error({choice.file}, text.error().what, text.error().remedy);
    return std::nullopt;
  }
  const bool mpc = std::filesystem::path(choice.file).extension() == ".mpc";
  const auto component = mpc ? parse_component(*text, choice.file, AnyFile(), diagnostics)
                             : parse_urdf_between(*text, choice.file, choice.base, choice.tip, diagnostics);
  if (!component) return std::nullopt;
  auto chain = chain_between(*component, choice.base, choice.tip);
  // What the reader found already needs no second message.
  if (!chain && diagnostics.ok()) add_finding(diagnostics, choice.file, chain.error());
  if (!chain || !diagnostics.ok()) return std::nullopt;
  const std::string name = component->robot ? component->robot->id : std::filesystem::path(choice.file).stem().string();
  const InverseClass inverse_class =
      component->robot ? component->robot->parameters.inverse_class : InverseClass::align_frame;
  return ChosenRobot{name, choice.base, choice.tip, std::move(*chain), inverse_class};
}

}  // namespace

void add_robot_options(cli::Command sub, RobotChoice& choice) {
  sub.option("--urdf", choice.file, "URDF or component file (.mpc)");
  sub.option("--base", choice.base, "link or node in which poses are given");
  sub.option("--tip", choice.tip, "link or node that is moved");
  sub.option("--cell", choice.cell,
             "instead of --urdf: a cell file; the base is the robot's ZP frame, the tip its TCP");
  sub.option("--robot", choice.robot, "robot of the cell");
}

std::string misuse(const RobotChoice& choice) {
  if (!choice.cell.empty()) {
    if (!choice.file.empty()) return "--urdf and --cell both name a robot; give one of them";
    if (!choice.base.empty() || !choice.tip.empty())
      return "--base and --tip belong to --urdf; a cell's robot has its own";
    return choice.robot.empty() ? "--cell needs --robot ID" : "";
  }
  if (!choice.robot.empty()) return "--robot needs --cell F";
  if (choice.file.empty()) return "there is no robot; name one by --urdf F --base L --tip L, or by --cell F --robot ID";
  if (choice.base.empty()) return "--urdf needs --base LINK";
  return choice.tip.empty() ? "--urdf needs --tip LINK" : "";
}

std::optional<ChosenRobot> choose_robot(const RobotChoice& choice, Diagnostics& diagnostics) {
  return choice.cell.empty() ? robot_of_file(choice, diagnostics) : robot_of_cell(choice, diagnostics);
}

Result<std::vector<double>> parse_joints(const std::string& text, const std::string& option,
                                         const kinematics::Chain& chain) {
  std::vector<double> values;
  std::string_view rest = text;
  constexpr std::string_view kSeparators = " \t\r\n,";
  for (;;) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kSeparators), rest.size()));
    if (rest.empty()) break;
    const std::string_view word = rest.substr(0, rest.find_first_of(kSeparators));
    rest.remove_prefix(word.size());
    const auto value = parse_number(word);
    if (!value)
      return fail(
          fmt::format("{}: value {} is not a finite number: {}", option, values.size() + 1, printable(word, 40)));
    values.push_back(*value);
  }
  if (values.size() == chain.variable_count()) return values;
  std::string names;
  for (const kinematics::Variable& variable : chain.variables()) names += " " + variable.name;
  return fail(fmt::format("{}: {} values, the chain has {} joints", option, values.size(), chain.variable_count()),
              "in this order:" + names);
}

std::string beyond_limits(const kinematics::Chain& chain, std::span<const double> q) {
  std::string out;
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    if (q[i] >= chain.lower()[i] && q[i] <= chain.upper()[i]) continue;
    out += fmt::format("{}{} = {:g} is beyond {:g}..{:g} {}", out.empty() ? "" : "; ", chain.variables()[i].name, q[i],
                       chain.lower()[i], chain.upper()[i], chain.rotates(i) ? "rad" : "m");
  }
  return out;
}

}  // namespace cellmirror::app
