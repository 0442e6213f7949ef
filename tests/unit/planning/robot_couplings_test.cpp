// The rules for robots that follow others (manual 1.2.4), on a cell of small arms.
#include "rt_core/planning/robot_couplings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::planning {
namespace {

using testing::HasSubstr;
using Pairs = std::vector<std::pair<std::string_view, std::string_view>>;

class CouplingRules : public testing::Test {
 protected:
  CouplingRules() {
    std::string nodes;
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    for (const char* id : {"A", "B", "C", "D", "E", "F", "G"}) {
      nodes += std::string("[[node]]\nname = \"N") + id + "\"\nabstract = \"arm.mpc\"\nrobot_id = \"" + id + "\"\n";
    }
    Diagnostics diagnostics;
    cell_ = build_cell(nodes, files, diagnostics);
    EXPECT_TRUE(cell_) << diagnostics.text();
  }

  // Empty, or why it was refused.
  std::string couple(std::string_view master, std::string_view slave, const Pairs& joints = {{"TURN", "TURN"}}) {
    const SlaveJoints wanted{slave, joints};
    const auto changes = sut_.coupled(*cell_, master, std::span(&wanted, 1),
                                      [this](std::string_view robot) { return robot == mirrored_; });
    if (!changes) return changes.error().what;
    for (const auto& [name, coupling] : *changes) sut_.apply(name, coupling);
    return "";
  }
  std::string free(std::string_view master, std::string_view slave, const Pairs& joints) {
    const SlaveJoints wanted{slave, joints};
    const auto changes = sut_.freed(*cell_, master, std::span(&wanted, 1));
    if (!changes) return changes.error().what;
    for (const auto& [name, coupling] : *changes) sut_.apply(name, coupling);
    return "";
  }

  std::optional<Cell> cell_;
  std::string mirrored_;
  RobotCouplings sut_;
};

TEST_F(CouplingRules, JointsFollowUntilTheyAreFreed) {
  EXPECT_EQ(couple("A", "B", {{"TURN", "BEND"}, {"LIFT", "LIFT"}}), "");
  ASSERT_NE(sut_.find("B"), nullptr);
  EXPECT_EQ(sut_.find("B")->master, "A");
  ASSERT_EQ(sut_.find("B")->joints.size(), 2U);
  EXPECT_EQ(sut_.find("B")->joints[0].master_joint, 1);
  EXPECT_EQ(sut_.find("B")->joints[0].slave_joint, 2);
  EXPECT_EQ(free("A", "B", {{"TURN", "BEND"}}), "");
  ASSERT_EQ(sut_.find("B")->joints.size(), 1U);
  EXPECT_EQ(free("A", "B", {{"LIFT", "LIFT"}}), "");
  EXPECT_EQ(sut_.find("B"), nullptr);
}

TEST_F(CouplingRules, ASlaveHasOneMasterAndNobodyFollowsHimself) {
  EXPECT_EQ(couple("A", "B"), "");
  EXPECT_THAT(couple("C", "B"), HasSubstr("B follows A already"));
  EXPECT_THAT(couple("A", "A"), HasSubstr("cannot be its own slave"));
  EXPECT_EQ(couple("A", "B", {{"BEND", "BEND"}}), "") << "the same master: other joints in place of those before";
  EXPECT_EQ(sut_.find("B")->joints.size(), 1U);
}

TEST_F(CouplingRules, CirclesAreRefusedThroughAnyNumberOfRobots) {
  EXPECT_EQ(couple("A", "B"), "");
  EXPECT_EQ(couple("B", "C"), "");
  EXPECT_THAT(couple("C", "A"), HasSubstr("circle"));
  EXPECT_THAT(couple("B", "A"), HasSubstr("circle"));
  EXPECT_EQ(couple("C", "D"), "");
}

TEST_F(CouplingRules, JointsMustExistBeOfOneKindAndBeDrivenOnce) {
  EXPECT_THAT(couple("A", "B", {{"TURM", "TURN"}}), HasSubstr("A has no joint TURM"));
  EXPECT_THAT(couple("A", "B", {{"TURN", "GRIP"}}), HasSubstr("B has no joint GRIP"));
  EXPECT_THAT(couple("A", "B", {{"LIFT", "TURN"}}), HasSubstr("cannot follow the other"));
  EXPECT_THAT(couple("A", "B", {{"TURN", "BEND"}, {"BEND", "BEND"}}), HasSubstr("would follow two joints"));
  EXPECT_THAT(couple("A", "nobody"), HasSubstr("nobody"));
  EXPECT_EQ(sut_.find("B"), nullptr) << "nothing of what was refused was done";
}

TEST_F(CouplingRules, ARobotThatIsMirroredDoesNotFollow) {
  mirrored_ = "B";
  EXPECT_THAT(couple("A", "B"), HasSubstr("B is mirrored"));
}

TEST_F(CouplingRules, AMasterHasAtMostFiveSlaves) {
  for (const char* slave : {"B", "C", "D", "E", "F"}) EXPECT_EQ(couple("A", slave), "");
  EXPECT_THAT(couple("A", "G"), HasSubstr("would have 6 slaves"));
  EXPECT_EQ(couple("F", "G"), "") << "a slave may have slaves";
}

TEST_F(CouplingRules, OnlyWhatFollowsIsFreed) {
  EXPECT_EQ(couple("A", "B"), "");
  EXPECT_THAT(free("C", "B", {{"TURN", "TURN"}}), HasSubstr("B does not follow C"));
  EXPECT_THAT(free("A", "B", {{"BEND", "BEND"}}), HasSubstr("BEND of B does not follow BEND of A"));
  EXPECT_EQ(sut_.find("B")->joints.size(), 1U);
}

}  // namespace
}  // namespace cellmirror::planning
