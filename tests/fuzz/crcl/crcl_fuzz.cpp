// Bytes as a CRCL document. Besides crashes: a program comes out just where nothing is wrong, findings lie in the text,
// and what was read is executed.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scripts/programs/crcl/crcl.hpp"
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
  [[nodiscard]] bool digital_input(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_input(std::size_t /*number*/) const override { return 0; }
  [[nodiscard]] bool digital_output(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_output(std::size_t /*number*/) const override { return 0; }
};

void require(bool holds) {
  if (!holds) std::abort();
}

void execute(const std::shared_ptr<const Program>& program) {
  const World world;
  Machine machine(program, kJoints);
  for (int steps = 0; steps < 2000; ++steps) {
    if (machine.next(world, 50) != Machine::Step::command) return;
    require(!trace_line(*program, machine.command()).empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics;
  const auto program = crcl_language().parse(text, {.file = "fuzz.crcl", .codes = {}}, diagnostics);
  require((program != nullptr) == diagnostics.ok());
  for (const Diagnostic& finding : diagnostics.all()) {
    require(finding.place.line >= 0 && static_cast<std::size_t>(finding.place.line) <= size + 1);
    require(finding.place.column >= 0 && static_cast<std::size_t>(finding.place.column) <= size + 1);
    require(!finding.message.empty());
  }
  if (program == nullptr) return 0;
  require(program->places.size() == program->statements.size());
  Diagnostics unfit;
  program->check_for(kJoints, unfit);
  if (unfit.ok()) execute(program);
  return 0;
}
