// What a gateway would refuse of SCRIPT commands that are right as a text: files that are not there, joint values
// beyond the robot.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "app/owner/tissue/tissue_objects.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/robot_model.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/programs/program/language.hpp"

namespace cellmirror::app {

using PlaceOf = std::function<Place(std::string_view word)>;

// Follows the commands of a text in their order, and into the files that it calls: what they make (TF_RECORD,
// SAVE_VIEWS) and set (ROBACT, ROBOT_LANGUAGE, rob_jnt_*) holds for those behind. All diagnostics are warnings, since
// other scripts may have run before. One thread.
class CommandChecks {
 public:
  // All of them outlive the checks.
  CommandChecks(const LoadedCell& cell, const NameDirectory& names, Diagnostics& diagnostics);

  void follow(const script::ParsedCommand& command, const PlaceOf& place_of);

 private:
  void check_program(const script::ParsedCommand& command, const PlaceOf& place_of);
  void check_tissue_object(const script::ParsedCommand& command, const PlaceOf& place_of);
  void check_tissue_file(const script::ParsedCommand& command, std::string_view extension, const PlaceOf& place_of);
  void check_volumes(const script::ParsedCommand& command, const PlaceOf& place_of);
  void check_views(const script::ParsedCommand& command, const PlaceOf& place_of);
  void call(const script::ParsedCommand& command, const PlaceOf& place_of);
  void follow_file(const std::filesystem::path& path);
  void check_joints(const script::ParsedCommand& command, std::size_t first, const PlaceOf& place_of);
  void set_joints(const script::ParsedCommand& command, const PlaceOf& place_of);
  void warn(const Place& place, const script::ParsedCommand& command, const Error& why) const;
  // With what the text has set so far. Null: the cell has no such robot.
  RobotModel* robot(std::string_view id);

  const LoadedCell& cell_;
  const NameDirectory& names_;
  Diagnostics* diagnostics_;  // null while a file that was called is followed: it is checked by itself
  const program::Language* language_;
  TissueObjects tissue_objects_;
  std::string active_robot_;
  std::map<std::string, RobotModel, std::less<>> robots_;
  std::set<std::string, std::less<>> recorded_programs_;
  std::set<std::string, std::less<>> saved_views_;
  std::size_t files_followed_ = 0;
  std::set<std::filesystem::path> called_;  // and not ended yet
};

// Joints beyond their ranges of `robot`, each passed to `report` with its index and why. `values`: rad or m, of the
// first joints.
void check_joint_values(const RobotModel& robot, std::span<const double> values,
                        const std::function<void(std::size_t joint, const Error& why)>& report);

// A SCRIPT file as a whole. `cell` and `names` may be null: names, files and ranges are not looked at then.
void check_script_file(const std::filesystem::path& path, const LoadedCell* cell, const NameDirectory* names,
                       Diagnostics& diagnostics);

}  // namespace cellmirror::app
