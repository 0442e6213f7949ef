// Words that have a meaning within parameters and can therefore not be names of variables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scripts/programs/program/expression.hpp"

namespace cellmirror::program::irdata {

enum class Word : std::uint8_t {
  on,
  off,
  true_word,
  false_word,
  pi,
  pose,
  joints,
  here,
  here_joints,
  din,
  ain,
  dout,
  aout,
  first,
  last,
  length,
  abs,
  sqrt,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan2,
  min,
  max,
  round,
  trunc,
  real,
  inv,
  // operators
  logical_and,
  logical_or,
  logical_xor,
  logical_not,
  div,
  mod,
  // of single operations
  fly,
  default_word,
  speed,
  distance,
  angle,
  boolean,
  integer,
};
// Without regard to case; none where it is free for names.
[[nodiscard]] std::optional<Word> find_word(std::string_view text);

// A function whose arguments are numbers (inv: a pose).
struct FunctionRow {
  Word word = Word::abs;
  Operator which = Operator::absolute;
  std::uint8_t arguments = 1;
  bool takes_degrees = false;
  bool gives_degrees = false;
};
// Null if the word is not one of them.
[[nodiscard]] const FunctionRow* find_function(Word word);
[[nodiscard]] const FunctionRow& function_of(Operator which);  // which is among them

// X, Y, Z, ROLL, PITCH, YAW of a pose as 0..5; J1, J2, ... of joint values as 0...
[[nodiscard]] std::optional<std::uint32_t> find_pose_component(std::string_view text);
[[nodiscard]] std::optional<std::uint32_t> find_joint_component(std::string_view text);
// From metres or radians to what the dialect writes.
[[nodiscard]] double written_per_si(std::uint32_t pose_component);

}  // namespace cellmirror::program::irdata
