// The words of SRCL. The only place that spells them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror::program::srcl {

enum class Keyword : std::uint8_t {
  none,
  // declarations
  program,
  integer,
  real,
  boolean,
  pose,
  joints,
  constant,
  list,
  semaphore,
  // moves, and what is said of them
  ptp,
  linear,
  circular,
  relative,
  tool_axes,
  fly,
  // settings
  joint_velocity,
  joint_acceleration,
  path_velocity,
  path_acceleration,
  turn_velocity,
  turn_acceleration,
  fly_distance,
  fly_angle,
  fly_speed,
  tool,
  zero_point,
  standard,
  // flow
  jump,
  if_begin,
  then,
  else_if,
  otherwise,
  if_end,
  while_begin,
  while_end,
  count_begin,
  from,
  until,  // of a wait, a count and a repetition
  step,
  count_end,
  repeat_begin,
  loop_begin,
  loop_end,
  leave,
  next_round,
  subprogram,
  subprogram_end,
  call,
  return_back,
  halt,
  end,
  // waits and semaphores
  wait,
  at_most,
  notify,
  acquire,
  release,
  // inputs and outputs
  digital_input,
  digital_output,
  analogue_input,
  analogue_output,
  // expressions
  logical_and,
  logical_or,
  logical_xor,
  logical_not,
  integer_divide,
  modulo,
  true_value,
  false_value,
  absolute,
  square_root,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  minimum,
  maximum,
  round,
  truncate,
  inverse,
  current_pose,
  current_joints,
  pi,
};

struct KeywordRow {
  std::string_view word;
  Keyword keyword = Keyword::none;
  bool begins_statement = false;
};

// All words; two rows may have the same keyword (WAHR, EIN).
[[nodiscard]] std::span<const KeywordRow> keyword_rows();
// Without regard to case; none where it is no word of the language.
[[nodiscard]] Keyword find_keyword(std::string_view word);
// As it is written: the first row with it.
[[nodiscard]] std::string_view spelling(Keyword keyword);
// For proposals where a word is misspelt.
[[nodiscard]] const std::vector<std::string>& statement_words();
[[nodiscard]] const std::vector<std::string>& all_words();

}  // namespace cellmirror::program::srcl
