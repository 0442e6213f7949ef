// Text as an IRDATA program; a text with a line "=codes=" has a table of codes behind it. Besides crashes: a program
// comes out just where nothing is wrong, findings lie in the text, and what was read is executed.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scripts/programs/irdata/irdata.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/trace.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

constexpr std::array<JointKind, 4> kJoints = {JointKind::revolute, JointKind::revolute, JointKind::prismatic,
                                              JointKind::continuous};

struct World final : ProgramWorld {
  [[nodiscard]] JointValues joints() const override { return {0.5, -0.25, 0.125}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return number % 2 == 0; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return static_cast<double>(number); }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return number % 2 == 1; }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return -static_cast<double>(number); }
};

void require(bool holds) {
  if (!holds) std::abort();
}

void execute(const std::shared_ptr<const Program>& program) {
  const World world;
  Machine machine(program, kJoints);
  for (int steps = 0; steps < 200; ++steps) {
    const Machine::Step step = machine.next(world, 50);
    if (step == Machine::Step::ended || step == Machine::Step::failed) return;
    if (step == Machine::Step::spent) continue;
    require(!trace_line(*program, machine.command()).empty());
    if (std::holds_alternative<WaitCommand>(machine.command().what) && !machine.holds(world)) {
      if (!std::get<WaitCommand>(machine.command().what).timeout_s) return;
      machine.time_out();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  ParseContext context;
  context.file = "fuzz.ird";
  constexpr std::string_view kCodes = "\n=codes=\n";
  if (const std::size_t codes = text.find(kCodes); codes != std::string_view::npos) {
    context.codes = text.substr(codes + kCodes.size());
    text = text.substr(0, codes);
  }
  Diagnostics diagnostics;
  const auto program = irdata_language().parse(text, context, diagnostics);
  require((program != nullptr) == diagnostics.ok());
  for (const Diagnostic& finding : diagnostics.all()) {
    require(finding.place.line >= 0 && static_cast<std::size_t>(finding.place.line) <= size + 1);
    require(finding.place.column >= 0 && static_cast<std::size_t>(finding.place.column) <= size + 2);
    require(!finding.message.empty());
  }
  if (!program) return 0;
  require(program->places.size() == program->statements.size());
  Diagnostics unfit;
  program->check_for(kJoints, unfit);
  if (unfit.ok()) execute(program);
  return 0;
}
