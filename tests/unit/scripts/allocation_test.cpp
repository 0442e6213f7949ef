// Reading correct commands and executing them leaves the heap alone.
#include <gtest/gtest.h>

#include <string>

#include "rt_core/rt/allocation_guard.hpp"
#include "scripts/commands/execute.hpp"
#include "tests/golden/scripts/quiet_host.hpp"
#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

TEST(ReadingAndExecuting, AllocatesNothingForCorrectCommands) {
  cellmirror::testing::QuietHost gateway;
  gateway.names.active = "MANTEC_RM3";
  CommandHost host = gateway.host();
  const std::string text =
      "# a comment\n"
      "POS_ROB MANTEC_RM3 JOINT_ABS 27.5 \xe2\x80\x93"
      "17.38 -11.02 37.338 0.9 -12.271;\n"
      "SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 PLACEMENT\n-88.5 16.32851 -180.0 -11920.0 2517.3 912.7;\n"
      "FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND Tool1_WFRM;\n"
      "rob_jnt_max_vel 1.9 1.4 5.2 3.1 4.0 3.9;\n"
      "rob_tcp_def 83.0, -170.0, 0.0, -90.0, 0.0, -30.0;\n"
      "SET_CAMPAR CAMERA_5 4.85 15.71;\n"
      "ROBOT MANTEC_R3 online;\n"
      "rob_inverse_class align_YZ_A_AXIS;\n";
  ASSERT_FALSE(forms_of("WAIT").empty());  // builds the table
  CommandReader reader(text, "file.spt", TextKind::file);
  ParsedCommand command;
  Diagnostics findings;
  std::size_t done = 0;
  std::uint64_t allocations = 0;
  bool first = true;
  for (;;) {
    const AllocationGuard guard;
    const CommandReader::Step step = reader.next(&gateway.names, command, findings);
    if (step == CommandReader::Step::end) break;
    if (execute(command, host).kind == Outcome::Kind::done) ++done;
    if (!first) allocations += guard.allocations();  // the first call builds the table of handlers
    first = false;
  }
  EXPECT_EQ(done, 8U) << findings.text();
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  EXPECT_EQ(allocations, 0U);
}

}  // namespace
}  // namespace cellmirror::script
