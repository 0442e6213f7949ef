// The description of one form of a command: what the command table is made of.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "scripts/lang/form_id.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::script {

// The unit of a number in SCRIPT text. It is converted to SI where the command is parsed, and nowhere else.
enum class Unit : std::uint8_t {
  none,
  mm,
  degree,
  metre,
  second,
  newton,
  newton_metre,
  mm_per_s,
  mm_per_s2,
  degree_per_s,
  degree_per_s2,
  byte,
  joint_position,      // mm of a prismatic joint, degrees of a rotational one
  joint_velocity,      // mm/s, rad/s
  joint_acceleration,  // mm/s2, rad/s2
  by_fly_type,         // rob_cart_fly_radius: none, mm or degrees by the fly type before it
  by_effector_joint,   // rob_ela_interact: like joint_position, for the joint numbered first
  by_plausibility,     // eladyn_plaus_param: as table A.5 says for the token
};

// Limits in the unit of the text.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;
  bool high_excluded = false;

  [[nodiscard]] constexpr bool holds(double value) const {
    return (low_excluded ? value > low : value >= low) && (high_excluded ? value < high : value <= high);
  }
  [[nodiscard]] constexpr bool bounded() const {
    return low > -std::numeric_limits<double>::max() || high < std::numeric_limits<double>::max();
  }
};

enum class ParameterKind : std::uint8_t {
  word,         // a fixed keyword, e.g. JOINT_ABS; takes no value slot
  choice,       // one of some keywords
  name,         // of a frame, robot, camera, sensor or workframe
  identifier,   // a name without a directory (geometry of a deformable object)
  file,         // of a file in the cell folder
  integer,      // decimal, or hexadecimal with 0x
  number,       // `width` numbers
  joint_list,   // one number a joint of the robot named before, or of the active robot; the last parameter
  number_list,  // 0 to `width` numbers; the last parameter
  slaves,       // the nested repetition of MASTER_SLAVE; the last parameter
  text,         // the rest of the command, verbatim
};

// A choice that is accepted, with what the reference page says of it.
struct Choice {
  std::string_view word;
  std::string_view meaning;
};

struct Parameter {
  std::string_view name;     // as in the synopsis
  std::string_view meaning;  // for messages and help, e.g. "velocity scale"
  ParameterKind kind = ParameterKind::number;
  Unit unit = Unit::none;
  Range range{};
  std::span<const Choice> choices{};
  NameKind name_kind = NameKind::frame_node;
  std::string_view label{};  // not empty: the label precedes the values, and labelled groups come in any order
  std::uint8_t width = 1;    // values, i.e. slots of ParsedCommand
  bool optional = false;
  bool exact_count = false;       // joint_list: one value for each joint, not fewer
  bool checked_by_host = false;   // name: may be of something that is not loaded yet, so the gateway looks it up
  std::uint8_t alternatives = 0;  // not 0: of the labelled groups with this number at most one may be given
  std::string_view default_text{};
};

enum class FormKind : std::uint8_t {
  command,
  convention,  // of the manual's index, but no command: comment lines, the names of the foot switches' files
};

enum class Origin : std::uint8_t { manual, ours };

// What executing the form means for the real-time loop.
enum class LoopEffect : std::uint8_t {
  none,      // the tick does not see it
  queued,    // reaches the tick with the next published snapshot or through a Fifo
  blocking,  // suspends the script that contains it (never the loop)
};

// How a form is distinguished from others of the same command.
enum class Selector : std::uint8_t {
  only_form,
  by_first_word,   // the first parameter
  by_second_word,  // the second parameter
  by_third_word,   // the third parameter
  by_shape,        // eladyn_geo_def
};

struct Form {
  FormId id{};
  std::string_view name;     // the command's first word
  std::string_view syntax;   // the synopsis
  std::string_view section;  // of the manual, or "ours"
  std::span<const Parameter> parameters{};
  std::string_view help;       // one line
  std::string_view example{};  // the manual's own where it has one
  // The manual's example does not go with those before it in the manual: why. Empty: it is done after them.
  std::string_view conflict{};
  std::string_view definition{};  // what the manual leaves open and we define
  LoopEffect effect = LoopEffect::none;
  Selector selector = Selector::only_form;
  FormKind kind = FormKind::command;
  Origin origin = Origin::manual;
  bool needs_active_robot = false;
  bool commas = false;        // the synopsis has commas between the values: accepted, not demanded
  bool at_least_one = false;  // of the labelled groups
};

}  // namespace cellmirror::script
