#include "scripts/programs/crcl/command_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "rt_core/base/text.hpp"
#include "scripts/programs/program/script_comment.hpp"

namespace cellmirror::crcl {

using program::ExpressionId;
using program::Setting;

CommandReader::Handler CommandReader::handler_of(std::string_view type) {
  static const std::unordered_map<std::string_view, Handler> handlers = {
      {"ActuateJointsType", &CommandReader::actuate_joints},
      {"CloseToolChangerType", &CommandReader::tool_changer},
      {"ConfigureJointReportsType", &CommandReader::no_effect},
      {"ConfigureStatusReportType", &CommandReader::no_effect},
      {"DwellType", &CommandReader::dwell},
      {"GetStatusType", &CommandReader::no_effect},
      {"MessageType", &CommandReader::message},
      {"MoveScrewType", &CommandReader::move_screw},
      {"MoveThroughToType", &CommandReader::move_through_to},
      {"MoveToType", &CommandReader::move_to},
      {"OpenToolChangerType", &CommandReader::tool_changer},
      {"RunProgramType", &CommandReader::run_program},
      {"SetAngleUnitsType", &CommandReader::set_angle_units},
      {"SetEndEffectorParametersType", &CommandReader::parameters},
      {"SetEndEffectorType", &CommandReader::set_end_effector},
      {"SetEndPoseToleranceType", &CommandReader::set_end_tolerance},
      {"SetForceUnitsType", &CommandReader::set_force_units},
      {"SetIntermediatePoseToleranceType", &CommandReader::set_intermediate_tolerance},
      {"SetLengthUnitsType", &CommandReader::set_length_units},
      {"SetMotionCoordinationType", &CommandReader::set_coordination},
      {"SetRobotParametersType", &CommandReader::parameters},
      {"SetRotAccelType", &CommandReader::set_limit},
      {"SetRotSpeedType", &CommandReader::set_limit},
      {"SetTorqueUnitsType", &CommandReader::set_force_units},
      {"SetTransAccelType", &CommandReader::set_limit},
      {"SetTransSpeedType", &CommandReader::set_limit},
      {"StopMotionType", &CommandReader::stop_motion},
  };
  const auto found = handlers.find(type);
  return found == handlers.end() ? nullptr : found->second;
}

void CommandReader::read(const XmlTree& tree) {
  const XmlNode& node = tree.root();
  const Fields fields(tree, file_, diagnostics_);
  if (node.name == "Name") return builder_.rename(printable(node.text));
  const bool init = node.name == "InitCanon";
  const bool middle = node.name == "MiddleCommand";
  if (!init && !middle && node.name != "EndCanon") {
    return fields.error(node, fmt::format("<{}> does not belong here", printable(node.name)),
                        "a program is InitCanon, any number of MiddleCommand, EndCanon");
  }
  place(fields, node);
  if (init) {
    if (part_ != Part::before) fields.error(node, "<InitCanon> must come once, at the beginning of the program");
    part_ = Part::commands;
    return fields.only(node, {"CommandID"});
  }
  if (part_ == Part::before) {
    fields.error(node, fmt::format("<{}> before <InitCanon>", node.name));
    part_ = Part::commands;
  }
  if (part_ == Part::behind) return fields.error(node, fmt::format("<{}> after <EndCanon>", node.name));
  if (middle) return middle_command(fields, node);
  part_ = Part::behind;
  fields.only(node, {"CommandID"});
  add(fields, node, program::EndStatement{});
}

void CommandReader::finish(const Place& root) {
  if (part_ == Part::behind || !diagnostics_.ok()) return;
  diagnostics_.error(root, part_ == Part::before ? "the program has no <InitCanon>" : "the program has no <EndCanon>");
}

// People call a step by its Name, or by its CommandID.
void CommandReader::place(const Fields& fields, const XmlNode& node) {
  const auto id = fields.positive_integer(node, "CommandID");
  const XmlNode* name = fields.optional(node, "Name");
  std::string label = name == nullptr ? std::string() : printable(name->text);
  if (label.empty() && id) label = fmt::format("command {}", *id);
  builder_.at(node.line, node.column, label);
}

void CommandReader::middle_command(const Fields& fields, const XmlNode& node) {
  if (node.type.empty()) return fields.error(node, "<MiddleCommand> without xsi:type", "as xsi:type=\"MoveToType\"");
  const Handler handler = handler_of(node.type);
  if (handler == nullptr) {
    return fields.error(node, fmt::format("'{}' is not a known command of CRCL", printable(node.type)),
                        "docs/languages/crcl.md lists them");
  }
  (this->*handler)(fields, node);
}

void CommandReader::add(const Fields& fields, const XmlNode& node, const program::Statement& statement) {
  if (const auto added = builder_.add(statement); !added) {
    fields.error(node, added.error().what, added.error().remedy);
  }
}

void CommandReader::dwell(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "DwellTime"});
  const auto seconds = fields.number(node, "DwellTime");
  if (seconds) add(fields, node, program::DelayStatement{builder_.real(*seconds)});
}

// Shown by hot_message; one that begins with % is a SCRIPT command, as the comments of IRDATA are.
void CommandReader::message(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "Message"});
  const XmlNode* text_node = fields.required(node, "Message");
  if (text_node == nullptr) return;
  std::string text(text_node->text);
  std::replace_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), both_blank), text.end());
  const bool script = text.starts_with('%');
  if (!script) std::replace(text.begin(), text.end(), ';', ',');  // would end the command
  const std::string_view command =
      program::script_command(trimmed(script ? std::string_view(text).substr(1) : std::string_view(text)));
  if (command.empty()) return fields.error(*text_node, "the message is empty");
  const std::string line = script ? std::string(command) : "hot_message " + std::string(command);
  add(fields, node, program::ScriptStatement{builder_.text(line)});
}

void CommandReader::no_effect(const Fields& /*fields*/, const XmlNode& /*node*/) {}

void CommandReader::parameters(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "ParameterSetting"}, "ParameterSetting");
  for (const XmlNode* one = fields.tree().first(node); one != nullptr; one = fields.tree().next(*one)) {
    if (one->name != "ParameterSetting") continue;
    fields.only(*one, {"ParameterName", "ParameterValue"});
    const XmlNode* name = fields.required(*one, "ParameterName");
    const XmlNode* value = fields.required(*one, "ParameterValue");
    if (name == nullptr || value == nullptr) continue;
    fields.warning(*one, fmt::format("the parameter '{}' is unknown and has no effect", printable(name->text)));
  }
}

void CommandReader::run_program(const Fields& fields, const XmlNode& node) {
  fields.error(node, "a program of another language within a program cannot be run",
               "load it as a separate program (TF_LOAD) and run both in sequence (TF_RUN ... exec_wait)");
}

void CommandReader::set_angle_units(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "UnitName"});
  const XmlNode* unit = fields.required(node, "UnitName");
  if (unit == nullptr) return;
  if (unit->text != "radian" && unit->text != "degree") {
    return fields.error(*unit, fmt::format("'{}' is not a unit of angles", printable(unit->text)), "radian or degree");
  }
  units_.angle = unit->text == "degree" ? AngleUnit::degree : AngleUnit::radian;
}

void CommandReader::set_length_units(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "UnitName"});
  const XmlNode* unit = fields.required(node, "UnitName");
  if (unit == nullptr) return;
  if (unit->text == "meter") {
    units_.length = LengthUnit::metre;
  } else if (unit->text == "millimeter") {
    units_.length = LengthUnit::millimetre;
  } else if (unit->text == "inch") {
    units_.length = LengthUnit::inch;
  } else {
    fields.error(*unit, fmt::format("'{}' is not a unit of length", printable(unit->text)),
                 "meter, millimeter or inch");
  }
}

// Forces are not part of the motion; only the name is checked.
void CommandReader::set_force_units(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "UnitName"});
  const XmlNode* unit = fields.required(node, "UnitName");
  if (unit == nullptr) return;
  const bool force = node.type == "SetForceUnitsType";
  const bool known = force ? unit->text == "newton" || unit->text == "pound" || unit->text == "ounce"
                           : unit->text == "newtonMeter" || unit->text == "footPound";
  if (known) return;
  fields.error(*unit, fmt::format("'{}' is not a unit of {}", printable(unit->text), force ? "forces" : "torques"),
               force ? "newton, pound or ounce" : "newtonMeter or footPound");
}

// Rotation and translation end together in every straight move here, which either value allows.
void CommandReader::set_coordination(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "Coordinated"});
  static_cast<void>(fields.boolean(node, "Coordinated"));
}

// Output 1 is on where the setting is above 0, analogue output 1 has its value.
void CommandReader::set_end_effector(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "Setting"});
  const XmlNode* setting = fields.required(node, "Setting");
  const auto value = setting == nullptr ? std::nullopt : fields.fraction(*setting);
  if (!value) return;
  const ExpressionId analogue = builder_.integer(1);
  add(fields, node, program::OutputStatement{.analogue = true, .number = analogue, .value = builder_.real(*value)});
  const ExpressionId digital = builder_.integer(1);
  add(fields, node, program::OutputStatement{.number = digital, .value = builder_.boolean(*value > 0)});
}

// Moves end exactly where they should.
void CommandReader::set_end_tolerance(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "Tolerance"});
  const XmlNode* tolerance = fields.required(node, "Tolerance");
  if (tolerance != nullptr) static_cast<void>(read_tolerance(fields, *tolerance, units_));
}

void CommandReader::set_intermediate_tolerance(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "Tolerance"});
  const XmlNode* tolerance = fields.required(node, "Tolerance");
  if (tolerance != nullptr) through_tolerance_m_ = read_tolerance(fields, *tolerance, units_);
}

void CommandReader::set_limit(const Fields& fields, const XmlNode& node) {
  for (const LimitName& name : limit_names()) {
    if (node.type != fmt::format("Set{}Type", name.element)) continue;
    fields.only(node, {"CommandID", name.element});
    const XmlNode* value = fields.required(node, name.element);
    if (value == nullptr) return;
    limits_.at(static_cast<std::size_t>(name.limit)) = read_limit(fields, *value, name, units_);
  }
}

// Every command before it has ended when it comes.
void CommandReader::stop_motion(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID", "StopCondition"});
  const XmlNode* condition = fields.required(node, "StopCondition");
  if (condition == nullptr) return;
  if (condition->text == "Immediate" || condition->text == "Fast" || condition->text == "Normal") return;
  fields.error(*condition, fmt::format("'{}' is not a stop condition", printable(condition->text)),
               "Immediate, Fast or Normal");
}

void CommandReader::tool_changer(const Fields& fields, const XmlNode& node) {
  fields.only(node, {"CommandID"});
  if (std::exchange(told_tool_changer_, true)) return;
  fields.warning(node, "tool changes are not supported: the robot keeps its TCP",
                 "a message %rob_tcp_def ... sets another one");
}

}  // namespace cellmirror::crcl
