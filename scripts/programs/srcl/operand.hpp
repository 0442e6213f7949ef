// A part of an expression while it is read: a constant that may still be computed with, or a node of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scripts/programs/program/program.hpp"

namespace cellmirror::program::srcl {

struct Operand {
  enum class Form : std::uint8_t {
    unknown,  // invalid, which has been reported
    integer,
    real,
    boolean,
    stored,  // a pose or joints: `index` of Program::constants
    node,    // `index` of Program::expressions
  };
  Form form = Form::unknown;
  ValueType type = ValueType::real;
  std::uint8_t depth = 1;  // nodes above each other
  bool truth = false;
  std::uint32_t index = 0;
  std::int64_t integer = 0;
  double real = 0;

  [[nodiscard]] static Operand of(std::int64_t value);
  [[nodiscard]] static Operand of(double value);
  [[nodiscard]] static Operand of(bool value);

  [[nodiscard]] bool known() const { return form != Form::unknown; }
  [[nodiscard]] bool constant() const { return known() && form != Form::node; }
  [[nodiscard]] bool is(ValueType which) const { return known() && type == which; }
  [[nodiscard]] bool number() const { return is(ValueType::integer) || is(ValueType::real); }
  // Of constant numbers.
  [[nodiscard]] double value() const { return form == Form::integer ? static_cast<double>(integer) : real; }
};

// The word of SRCL for a type: "GANZ", ...
[[nodiscard]] std::string_view word_of(ValueType type);

}  // namespace cellmirror::program::srcl
