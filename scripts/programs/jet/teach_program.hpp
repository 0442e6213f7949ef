// Builds a program from check points and the statements between them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "scripts/programs/jet/teach_file.hpp"
#include "scripts/programs/program/program.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program {

// What is in force on the way to a check point. None: the robot's own parameters; a stop on the check point.
struct TeachSettings {
  std::optional<double> speed;         // share of each joint's highest velocity, (0, 1]
  std::optional<double> acceleration;  // likewise
  std::optional<TeachTolerance> tolerance;
};

// Settings become statements where they change, so that traces show only the file's settings. Refusals have no place.
class TeachProgram {
 public:
  TeachProgram(TeachDialect dialect, std::string_view file);

  void rename(std::string_view name) { builder_.rename(std::string(name)); }
  // Expected number of lines; a hint.
  void reserve(std::size_t lines) { builder_.reserve(std::min(lines, kMostReserved)); }
  // Place of the following statements in the file.
  void at(int line, int column);
  Result<void> point(std::string_view name, const JointPosition& target, const TeachSettings& settings);
  Result<void> dwell(double seconds);
  Result<void> hold() { return builder_.add(PauseStatement{}); }
  Result<void> output(std::uint16_t number, bool on);
  Result<void> script(std::string_view text) { return builder_.add(ScriptStatement{builder_.text(text)}); }
  // One more line could go beyond kMostStatements.
  [[nodiscard]] bool full() const { return builder_.next_statement() + kMostOfALine > kMostStatements; }
  // As ProgramBuilder::build().
  std::shared_ptr<const Program> build(Diagnostics& diagnostics, std::shared_ptr<const Program>* read_part = nullptr) {
    return builder_.build(diagnostics, read_part);
  }

 private:
  static constexpr std::size_t kMostReserved = 250'000;
  static constexpr std::size_t kMostOfALine = 4;  // a check point with three settings

  Result<void> set(Setting setting, const std::optional<double>& value, std::optional<double>& in_force);
  Result<void> set(const TeachTolerance& tolerance);

  ProgramBuilder builder_;
  std::uint32_t line_ = 0;
  std::uint32_t column_ = 0;
  std::string label_;  // kept for its memory
  TeachSettings in_force_;
};

}  // namespace cellmirror::program
