#include "app/subcommands/check_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "app/owner/programs/program_files.hpp"
#include "app/owner/tissue/tissue_parts.hpp"
#include "app/owner/volume/volume_names.hpp"
#include "config/view_file.hpp"
#include "rt_core/base/home.hpp"
#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::app {

using script::FormId;
using script::ParsedCommand;

namespace {

constexpr std::string_view kScriptFolder = "scripts";
constexpr std::string_view kTissueFolder = "envlib";
// A text beyond this is no SCRIPT file; the reader has its own, smaller limit and says so.
constexpr std::size_t kLargestText = std::size_t{256} << 20;
constexpr std::size_t kMostFilesFollowed = 256;  // of all calls within a text

std::optional<JointParameter> joint_parameter(FormId id) {
  constexpr std::array<std::pair<FormId, JointParameter>, 9> kParameters{{
      {FormId::rob_jnt_max_range, JointParameter::max_range},
      {FormId::rob_jnt_min_range, JointParameter::min_range},
      {FormId::rob_jnt_start_pos, JointParameter::start_position},
      {FormId::rob_jnt_ref_pos, JointParameter::reference_position},
      {FormId::rob_jnt_max_vel, JointParameter::max_velocity},
      {FormId::rob_jnt_min_vel, JointParameter::min_velocity},
      {FormId::rob_jnt_act_vel, JointParameter::active_velocity},
      {FormId::rob_jnt_max_acc, JointParameter::max_acceleration},
      {FormId::rob_jnt_act_acc, JointParameter::active_acceleration},
  }};
  const auto* found = std::ranges::find(kParameters, id, &std::pair<FormId, JointParameter>::first);
  return found == kParameters.end() ? std::nullopt : std::optional(found->second);
}

// As SAVE_VIEWS and LOAD_VIEWS complete it.
std::string views_name(std::string_view name) {
  const bool whole = std::filesystem::path(name).has_extension();
  return std::string(name) + (whole ? std::string() : std::string(kViewExtension));
}

}  // namespace

void check_joint_values(const RobotModel& robot, std::span<const double> values,
                        const std::function<void(std::size_t joint, const Error& why)>& report) {
  JointValues tried = robot.parameters().start_position;
  const std::size_t joints = std::min(values.size(), robot.joint_count());
  for (std::size_t i = 0; i < joints; ++i) {
    const double start = std::exchange(tried[i], values[i]);
    const auto fits = robot.positions_to(std::span(tried).first(i + 1), robot.parameters().start_position);
    if (fits) continue;
    report(i, fits.error());
    tried[i] = start;  // so that the joints behind it are looked at
  }
}

CommandChecks::CommandChecks(const LoadedCell& cell, const NameDirectory& names, Diagnostics& diagnostics)
    : cell_(cell),
      names_(names),
      diagnostics_(&diagnostics),
      language_(&program::languages().front()),
      tissue_objects_(tissue_parts(cell.tissue, cell.home, nullptr).objects) {}

RobotModel* CommandChecks::robot(std::string_view id) {
  if (const auto known = robots_.find(id); known != robots_.end()) return &known->second;
  const RobotModel* robot = cell_.cell.robot(id);
  return robot == nullptr ? nullptr : &robots_.emplace(std::string(id), *robot).first->second;
}

void CommandChecks::warn(const Place& place, const ParsedCommand& command, const Error& why) const {
  if (diagnostics_ != nullptr)
    diagnostics_->warning(place, fmt::format("{}: {}", command.form().name, why.what), why.remedy);
}

void CommandChecks::follow(const ParsedCommand& command, const PlaceOf& place_of) {
  switch (command.id()) {
    case FormId::robact:
      active_robot_ = command.text(0);
      return;
    case FormId::robot_language:
      if (const auto language = program::find_language(command.text(0))) language_ = *language;
      return;
    case FormId::tf_load:
      return check_program(command, place_of);
    case FormId::tf_record:
      recorded_programs_.emplace(command.text(0));
      return;
    case FormId::save_views:
      saved_views_.insert(views_name(command.text(0)));
      return;
    case FormId::load_views:
      return check_views(command, place_of);
    case FormId::eladyn_geo_def_flags:
    case FormId::eladyn_geo_def_token:
      return check_tissue_object(command, place_of);
    case FormId::eladyn_hyper_name:
      return check_tissue_file(command, kHyperExtension, place_of);
    case FormId::ela_clip_def:
      return check_tissue_file(command, kObjectExtension, place_of);
    case FormId::vv_clip:
    case FormId::vv_clip_pos:
    case FormId::vv_set_lut:
    case FormId::vv_set_lut_par_medical:
    case FormId::vv_set_lut_par:
      return check_volumes(command, place_of);
    case FormId::exec_script:
      return call(command, place_of);
    case FormId::pos_rob_joint_abs:
      return check_joints(command, 1, place_of);
    case FormId::move_rob_joint_abs:
      return check_joints(command, 2, place_of);
    default:
      return set_joints(command, place_of);
  }
}

void CommandChecks::check_program(const ParsedCommand& command, const PlaceOf& place_of) {
  const std::string_view name = command.text(0);
  if (recorded_programs_.contains(name)) return;
  const auto found = find_program_file(cell_.home, *language_, name);
  if (!found) warn(place_of(name), command, found.error());
}

void CommandChecks::check_views(const ParsedCommand& command, const PlaceOf& place_of) {
  const std::string_view name = command.text(0);
  if (saved_views_.contains(views_name(name))) return;
  const auto found = cell_.home.file(kScriptFolder, name, kViewExtension);
  if (!found) warn(place_of(name), command, found.error());
}

void CommandChecks::check_tissue_object(const ParsedCommand& command, const PlaceOf& place_of) {
  const std::string_view name = command.text(0);
  if (tissue_objects_.means_all(name)) return;
  const auto found = tissue_objects_.find(name);
  if (!found) warn(place_of(name), command, found.error());
}

void CommandChecks::check_tissue_file(const ParsedCommand& command, std::string_view extension,
                                      const PlaceOf& place_of) {
  const std::string_view name = command.text(0);
  const auto found = cell_.home.file(kTissueFolder, name, extension);
  if (!found) warn(place_of(name), command, found.error());
}

// A volume that is named is looked up as every name is.
void CommandChecks::check_volumes(const ParsedCommand& command, const PlaceOf& place_of) {
  if (names_.all(NameKind::volume).empty()) warn(place_of(command.text(0)), command, no_volumes());
}

void CommandChecks::call(const ParsedCommand& command, const PlaceOf& place_of) {
  const std::string_view name = command.text(0);
  const auto found = cell_.home.file(kScriptFolder, name, ".spt");
  if (found) return follow_file(*found);
  warn(place_of(name), command, found.error());
}

void CommandChecks::follow_file(const std::filesystem::path& path) {
  if (files_followed_ == kMostFilesFollowed || !called_.insert(path).second) return;
  ++files_followed_;
  if (const auto text = read_text_file(path, kLargestText)) {
    Diagnostics* const outside = std::exchange(diagnostics_, nullptr);
    Diagnostics of_that_file;
    script::ScriptChecker checker(
        &names_, [this](const ParsedCommand& command, const PlaceOf& place_of) { follow(command, place_of); });
    checker.check(*text, path.string(), script::TextKind::file, of_that_file);
    diagnostics_ = outside;
  }
  called_.erase(path);
}

void CommandChecks::check_joints(const ParsedCommand& command, std::size_t first, const PlaceOf& place_of) {
  const RobotModel* model = robot(command.text(0));
  if (model == nullptr || !command.converted()) return;
  std::array<double, kMaxJointsPerRobot> values;
  const std::size_t count = command.numbers(first, values);
  check_joint_values(*model, std::span(values).first(count), [&](std::size_t joint, const Error& why) {
    warn(place_of(command.text(first + joint)), command, {why.what, "it is refused where it is executed"});
  });
}

void CommandChecks::set_joints(const ParsedCommand& command, const PlaceOf& place_of) {
  const auto which = joint_parameter(command.id());
  RobotModel* model = which ? robot(active_robot_) : nullptr;
  if (model == nullptr || !command.converted()) return;
  std::array<double, kMaxJointsPerRobot> values;
  const std::size_t count = command.numbers(0, values);
  const auto set = model->set_joint_parameter(*which, std::span(values).first(count));
  if (!set) warn(place_of(command.text(0)), command, set.error());
}

void check_script_file(const std::filesystem::path& path, const LoadedCell* cell, const NameDirectory* names,
                       Diagnostics& diagnostics) {
  const auto text = read_text_file(path, kLargestText);
  if (!text) {
    diagnostics.error({path.string()}, text.error().what, text.error().remedy);
    return;
  }
  std::optional<CommandChecks> checks;
  script::CommandVisitor visit;
  if (cell != nullptr && names != nullptr) {
    checks.emplace(*cell, *names, diagnostics);
    visit = [&checks](const ParsedCommand& command, const PlaceOf& place_of) { checks->follow(command, place_of); };
  }
  script::ScriptChecker(names, std::move(visit)).check(*text, path.string(), script::TextKind::file, diagnostics);
}

}  // namespace cellmirror::app
