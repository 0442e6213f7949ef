#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Names : testing::Test {
  Names() {
    files->add("arm.mpc", kArm);
    Diagnostics diagnostics;
    sut = build_cell(R"(
[[node]]
name = "Arm_1"
abstract = "arm.mpc"
[[node]]
name = "Arm_2"
abstract = "arm.mpc"
robot_id = "OTHER"
[[node]]
name = "Lab"
[[node]]
name = "CAM"
parent = "Lab"
type = "camera"
[[node]]
name = "W"
parent = "Lab"
type = "workframe"
[[node]]
name = "Lab_2"
[[node]]
name = "Lab"
parent = "Lab_2"
[[node]]
name = "W"
parent = "Lab_2.Lab"
type = "workframe"
[[node]]
name = "Deep"
parent = "Lab_2.Lab"
)",
                     files, diagnostics);
    EXPECT_TRUE(sut) << diagnostics.text();
  }
  std::string found(const std::string& path, PathKind kind = PathKind::any) const {
    const auto node = sut->find(path, kind);
    return node ? sut->path(*node) : "refused: " + node.error().what;
  }
  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> sut;
};

TEST_F(Names, fullPathsAreFound) { EXPECT_EQ(found("Arm_1.LIFT.TURN.BEND.TIP"), "Arm_1.LIFT.TURN.BEND.TIP"); }

TEST_F(Names, levelsMayBeSkippedWhereOneNodeMatches) {
  EXPECT_EQ(found("Arm_1.TIP"), "Arm_1.LIFT.TURN.BEND.TIP");
  EXPECT_EQ(found("Arm_2.TURN.TIP"), "Arm_2.LIFT.TURN.BEND.TIP");
  EXPECT_EQ(found("Deep"), "Lab_2.Lab.Deep");
  EXPECT_EQ(found("CAM", PathKind::camera), "Lab.CAM");
}

TEST_F(Names, aPathWithoutSkippedLevelsWinsOverShortenedOnes) {
  EXPECT_EQ(found("Lab"), "Lab");
  EXPECT_EQ(found("Lab.W"), "Lab.W");
}

TEST_F(Names, ambiguousPathsAreRefusedWithTheCandidates) {
  const auto result = sut->find("TIP");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("ambiguous"));
  EXPECT_THAT(result.error().remedy, HasSubstr("Arm_1.LIFT.TURN.BEND.TIP"));
  EXPECT_THAT(result.error().remedy, HasSubstr("Arm_2.LIFT.TURN.BEND.TIP"));
  EXPECT_FALSE(sut->knows("W", PathKind::workframe));
}

TEST_F(Names, unknownPathsNameTheNearest) {
  const auto result = sut->find("Arm_1.TIPP");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().remedy, HasSubstr("Arm_1.LIFT.TURN.BEND.TIP"));
  EXPECT_THAT(sut->find("arm_1").error().remedy, HasSubstr("Arm_1")) << "names are case-sensitive";
}

TEST_F(Names, kindsAreTold) {
  EXPECT_EQ(found("Lab.CAM", PathKind::workframe), "refused: Lab.CAM is a camera, not a workframe");
  EXPECT_EQ(found("Lab.CAM"), "Lab.CAM") << "a camera is a frame_node too";
}

TEST_F(Names, faultyPathsAreUnknown) {
  for (const char* path : {"", ".", "..", "Lab.", ".Lab", "Lab..W", "Lab .W"}) EXPECT_FALSE(sut->knows(path)) << path;
  EXPECT_FALSE(sut->knows(std::string(100'000, 'a')));
  EXPECT_FALSE(sut->find(std::string(100'000, '.')));
}

TEST_F(Names, whatWasFoundIsForgottenWhenTheTreeChanges) {
  ASSERT_TRUE(sut->knows("Arm_2.TIP"));
  ASSERT_FALSE(sut->knows("TIP"));
  ASSERT_TRUE(sut->delete_node("Arm_2"));
  EXPECT_FALSE(sut->knows("Arm_2.TIP"));
  EXPECT_TRUE(sut->knows("TIP")) << "one is left";
  ASSERT_TRUE(sut->activate("Arm_2"));
  EXPECT_TRUE(sut->knows("Arm_2.TIP"));
  EXPECT_FALSE(sut->knows("TIP"));
}

TEST_F(Names, listsAllOfAKind) { EXPECT_THAT(sut->paths(PathKind::workframe), ElementsAre("Lab.W", "Lab_2.Lab.W")); }

TEST_F(Names, unknownRobotsNameTheNearest) {
  EXPECT_THAT(sut->explain_robot("OTHERS").remedy, HasSubstr("OTHER"));
  EXPECT_THAT(sut->explain_robot("completely different").remedy, HasSubstr("ARM, OTHER"));
}

}  // namespace
}  // namespace cellmirror
