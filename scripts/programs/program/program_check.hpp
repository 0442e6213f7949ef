// Types and bounds of whole programs. What a machine executes has been checked: ProgramBuilder does it as it goes, a
// parser that fills Program itself calls check_program() at its end.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// Reports statements with expressions of a wrong type, constants out of range, jumps to nowhere; sizes beyond the
// limits of program.hpp; and, in programs that run backward, what cannot. Broken indices (of nodes, variables, texts)
// are bugs of the parser, and reported too, so that no text whatever can harm the machine. Linear in the program.
void check_program(const Program& program, Diagnostics& diagnostics);

// One statement; `types`: of all expressions so far. Jump targets are not checked.
[[nodiscard]] Result<void> check_statement(const Program& program, std::span<const ValueType> types,
                                           const Statement& statement);
// Of a node whose operands have these types.
[[nodiscard]] Result<ValueType> node_type(const Program& program, const ExpressionNode& node,
                                          std::span<const ValueType> operands);
// What a setting takes: shares within (0, 1], velocities and accelerations above 0, fly-by 0 and above; finite.
[[nodiscard]] Result<void> check_setting(Setting setting, double value);
[[nodiscard]] std::string_view name_of(Setting setting);
// The value of a constant expression; null where it is not one.
[[nodiscard]] const Value* constant_value(const Program& program, ExpressionId id);
// Its number; none where it has none.
[[nodiscard]] std::optional<double> constant_number(const Program& program, ExpressionId id);

}  // namespace cellmirror::program
