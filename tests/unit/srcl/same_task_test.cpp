// The demo has one task in two languages: what comes out has to be the same, command by command.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scripts/programs/languages/languages.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/trace.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

class StillWorld : public ProgramWorld {
 public:
  [[nodiscard]] JointValues joints() const override { return {}; }
  [[nodiscard]] Result<Pose> position() const override { return Pose::Identity(); }
  [[nodiscard]] bool digital_input(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_input(std::size_t /*number*/) const override { return 0; }
  [[nodiscard]] bool digital_output(std::size_t /*number*/) const override { return false; }
  [[nodiscard]] double analogue_output(std::size_t /*number*/) const override { return 0; }
};

// Without the numbers of the lines.
std::vector<std::string> commands_of(const std::string& language, const std::string& file) {
  constexpr std::array kJoints = {JointKind::revolute, JointKind::revolute, JointKind::revolute,
                                  JointKind::revolute, JointKind::revolute, JointKind::revolute};
  const char* const source = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::ifstream in(std::string(source == nullptr ? "." : source) + "/config/cells/transfer_cell/programs/" + file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  Diagnostics findings;
  const auto program = find_language(language).value()->parse(text, {file, {}}, findings);
  EXPECT_TRUE(program) << findings.text();
  std::vector<std::string> commands;
  if (!program) return commands;
  const StillWorld world;
  Machine machine(program, kJoints);
  while (machine.next(world, 10'000) == Machine::Step::command) {
    const std::string line = trace_line(*program, machine.command());
    commands.push_back(line.substr(line.find(' ') + 1));
  }
  return commands;
}

TEST(SrclDemo, GivesTheCommandsOfItsTwinInIrdata) {
  const std::vector<std::string> sut = commands_of("srcl", "r3demo.src");
  EXPECT_GT(sut.size(), 40U);
  EXPECT_EQ(sut, commands_of("irdata", "r3demo.ird"));
}

}  // namespace
