// What the fuzz targets of all robot languages require of a parser, besides that it does not crash: a program comes out
// just where nothing is wrong, findings lie in the text, and what was read is executed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <variant>

#include "scripts/programs/program/language.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/trace.hpp"

namespace cellmirror::program {

inline void require(bool holds) {
  if (!holds) std::abort();
}

// The robot stands; every other input is on.
class FuzzWorld final : public ProgramWorld {
 public:
  [[nodiscard]] JointValues joints() const override { return {0.5, -0.25, 0.125}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return number % 2 == 0; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return static_cast<double>(number); }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return number % 2 == 1; }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return -static_cast<double>(number); }
};

// For a while, where it fits a robot of six joints. A wait whose condition does not hold is over at once where it has a
// time limit.
inline void execute_fuzzed(const std::shared_ptr<const Program>& program) {
  constexpr std::array kJoints = {JointKind::revolute,  JointKind::revolute,   JointKind::continuous,
                                  JointKind::prismatic, JointKind::continuous, JointKind::revolute};
  constexpr int kSteps = 200;
  constexpr std::size_t kBudget = 50;  // statements a step
  Diagnostics unfit;
  program->check_for(kJoints, unfit);
  if (!unfit.ok()) return;
  const FuzzWorld world;
  Machine machine(program, kJoints);
  for (int count = 0; count < kSteps; ++count) {
    const Machine::Step step = machine.next(world, kBudget);
    if (step == Machine::Step::ended || step == Machine::Step::failed) return;
    if (step == Machine::Step::spent) continue;
    require(!trace_line(*program, machine.command()).empty());
    const auto* const wait = std::get_if<WaitCommand>(&machine.command().what);
    if (wait == nullptr || machine.holds(world)) continue;
    if (!wait->timeout_s) return;
    machine.time_out();
  }
}

// The program, null where there are findings.
inline std::shared_ptr<const Program> read_fuzzed(const Language& language, std::string_view text,
                                                  std::string_view codes = {}) {
  Diagnostics findings;
  const ParseContext context = {.file = "fuzz", .codes = std::string(codes)};
  const std::shared_ptr<const Program> program = language.parse(text, context, findings);
  require((program != nullptr) == findings.ok());
  const std::size_t longest = std::max(text.size(), codes.size());  // a finding is in either
  for (const Diagnostic& finding : findings.all()) {
    require(!finding.message.empty());
    require(finding.place.line >= 0 && static_cast<std::size_t>(finding.place.line) <= longest + 1);
    require(finding.place.column >= 0 && static_cast<std::size_t>(finding.place.column) <= longest + 2);
  }
  if (program == nullptr) return nullptr;
  require(program->places.size() == program->statements.size());
  execute_fuzzed(program);
  return program;
}

}  // namespace cellmirror::program
