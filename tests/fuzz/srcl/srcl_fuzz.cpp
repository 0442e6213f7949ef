// Any text as a program of SRCL; what is read is executed for a while in a world where nothing moves. Besides crashes:
// there is a program where nothing is wrong and none else, and faults lie in the text.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/trace.hpp"
#include "scripts/programs/srcl/srcl.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

class StillWorld : public ProgramWorld {
 public:
  [[nodiscard]] JointValues joints() const override { return {}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return number % 2 == 1; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return static_cast<double>(number); }
  [[nodiscard]] bool digital_output(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_output(std::size_t /*number*/) const override { return 0; }
};

void require(bool holds) {
  if (!holds) std::abort();
}

void execute(const std::shared_ptr<const Program>& program) {
  constexpr int kCommands = 200;
  constexpr std::size_t kBudget = 200;
  constexpr int kTurns = 5;  // of an endless loop
  constexpr std::array kJoints = {JointKind::revolute,  JointKind::revolute, JointKind::revolute,
                                  JointKind::prismatic, JointKind::revolute, JointKind::revolute};
  Diagnostics unfit;
  program->check_for(kJoints, unfit);
  if (!unfit.ok()) return;
  const StillWorld world;
  Machine machine(program, kJoints);
  int turns = 0;
  for (int i = 0; i < kCommands && turns < kTurns; ++i) {
    const Machine::Step step = machine.next(world, kBudget);
    if (step == Machine::Step::ended || step == Machine::Step::failed) return;
    if (step == Machine::Step::spent) {
      ++turns;
      continue;
    }
    static_cast<void>(trace_line(*program, machine.command()));
    if (std::holds_alternative<WaitCommand>(machine.command().what) && !machine.holds(world)) machine.time_out();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics findings;
  const std::shared_ptr<const Program> program = srcl_language().parse(text, {"fuzz.src", {}}, findings);
  require((program != nullptr) == findings.ok());
  for (const Diagnostic& finding : findings.all()) {
    require(!finding.message.empty());
    require(finding.place.line >= 0 && static_cast<std::size_t>(finding.place.line) <= size + 1);
    require(finding.place.column >= 0 && static_cast<std::size_t>(finding.place.column) <= size + 1);
  }
  if (program) execute(program);
  return 0;
}
