// Words to values: numbers, integers, choices, and the conversion to SI. Private to the folder.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/ports/robot_state.hpp"
#include "scripts/lang/form.hpp"
#include "scripts/lang/lexer.hpp"

namespace cellmirror::script {

// Typographic dashes (UTF-8 or CP1252) count as minus. None where the word is no finite number.
[[nodiscard]] std::optional<double> number_of(const Token& token);
// Exact up to 2^53; also hexadecimal with 0x.
[[nodiscard]] std::optional<double> integer_of(const Token& token);
// Why number_of() or integer_of() gave nothing: "is not a number", ...
[[nodiscard]] std::string_view why_no_number(const Token& token, bool integer);

// The index of the choice, without regard to case.
[[nodiscard]] std::optional<std::size_t> choice_of(std::string_view word, std::span<const Choice> choices);

// For the units that depend on a joint `kind` is its kind; the other units ignore it. The units that depend on another
// value must have been resolved before.
[[nodiscard]] double to_si(double value, Unit unit, JointKind kind = JointKind::revolute);

// "0.01..1", "more than 0 mm", "more than 0 and less than 180 degrees"
[[nodiscard]] std::string range_text(const Range& range, Unit unit);

}  // namespace cellmirror::script
