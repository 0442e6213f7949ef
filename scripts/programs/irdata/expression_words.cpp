#include "scripts/programs/irdata/expression_words.hpp"

#include <algorithm>
#include <array>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/irdata/words.hpp"

namespace cellmirror::program::irdata {

namespace {

constexpr std::size_t kWords = static_cast<std::size_t>(Word::integer) + 1;
constexpr std::array<std::string_view, kWords> kWordTexts = {
    "ON",   "OFF",   "TRUE",  "FALSE", "PI",      "POSE",  "JOINTS",   "HERE",  "HERE_JOINTS", "DIN",    "AIN",
    "DOUT", "AOUT",  "FIRST", "LAST",  "LENGTH",  "ABS",   "SQRT",     "SIN",   "COS",         "TAN",    "ASIN",
    "ACOS", "ATAN2", "MIN",   "MAX",   "ROUND",   "TRUNC", "REAL",     "INV",   "AND",         "OR",     "XOR",
    "NOT",  "DIV",   "MOD",   "FLY",   "DEFAULT", "SPEED", "DISTANCE", "ANGLE", "BOOLEAN",     "INTEGER"};
static_assert(!kWordTexts.back().empty());

constexpr std::array<FunctionRow, 14> kFunctions = {{
    {Word::abs, Operator::absolute, 1, false, false},
    {Word::sqrt, Operator::square_root, 1, false, false},
    {Word::sin, Operator::sine, 1, true, false},
    {Word::cos, Operator::cosine, 1, true, false},
    {Word::tan, Operator::tangent, 1, true, false},
    {Word::asin, Operator::arc_sine, 1, false, true},
    {Word::acos, Operator::arc_cosine, 1, false, true},
    {Word::atan2, Operator::arc_tangent, 2, false, true},
    {Word::min, Operator::minimum, 2, false, false},
    {Word::max, Operator::maximum, 2, false, false},
    {Word::round, Operator::round, 1, false, false},
    {Word::trunc, Operator::truncate, 1, false, false},
    {Word::real, Operator::to_real, 1, false, false},
    {Word::inv, Operator::inverse, 1, false, false},
}};

constexpr std::array<std::string_view, 6> kPoseComponents = {"X", "Y", "Z", "ROLL", "PITCH", "YAW"};

}  // namespace

std::optional<Word> find_word(std::string_view text) {
  static const WordTable table{kWordTexts};
  const std::size_t index = table.find(text);
  if (index == WordTable::kNone) return std::nullopt;
  return static_cast<Word>(index);
}

const FunctionRow* find_function(Word word) {
  const auto row = std::ranges::find(kFunctions, word, &FunctionRow::word);
  return row == kFunctions.end() ? nullptr : &*row;
}

const FunctionRow& function_of(Operator which) {
  const auto row = std::ranges::find(kFunctions, which, &FunctionRow::which);
  CELLMIRROR_EXPECTS(row != kFunctions.end());
  return *row;
}

std::optional<std::uint32_t> find_pose_component(std::string_view text) {
  for (std::uint32_t i = 0; i < kPoseComponents.size(); ++i)
    if (equal_ignoring_case(text, kPoseComponents[i])) return i;
  return std::nullopt;
}

std::optional<std::uint32_t> find_joint_component(std::string_view text) {
  if (text.size() < 2 || text.size() > 3 || (text[0] != 'J' && text[0] != 'j')) return std::nullopt;
  std::uint32_t number = 0;
  for (const char c : text.substr(1)) {
    if (!is_digit(c)) return std::nullopt;
    number = number * 10 + static_cast<std::uint32_t>(c - '0');
  }
  if (number < 1 || number > kMaxJointsPerRobot) return std::nullopt;
  return number - 1;
}

double written_per_si(std::uint32_t pose_component) { return pose_component < 3 ? 1000.0 : 1.0 / kRadPerDeg; }

}  // namespace cellmirror::program::irdata
