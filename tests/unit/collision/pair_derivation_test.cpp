// Which pairs are tested, and why the others are not.
#include <gtest/gtest.h>

#include "tests/unit/collision/cell_of_bodies.hpp"

namespace cellmirror::collision {
namespace {

constexpr const char* kHall = R"(
[[node]]
name = "Hall"
geometry = [{ name = "floor", box_m = [6.0, 6.0, 0.1], xyz_m = [0.0, 0.0, -0.05] }]
[[node]]
name = "Part"
xyz_m = [1.0, 1.0, 0.2]
geometry = [{ name = "part", box_m = [0.1, 0.1, 0.1] }]
[[node]]
name = "Arm"
abstract = "arm.mpc"
)";

struct PairDerivationTest : CellOfBodies {};

TEST_F(PairDerivationTest, NamesBodiesByTheirNodes) {
  build(kHall);
  for (const char* name : {"Hall", "Part", "Arm", "Arm.J_1", "Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4"})
    EXPECT_TRUE(has_body(name)) << name;
  EXPECT_EQ(table->bodies.size(), 7U);
  EXPECT_EQ(table->revision, compiled->revision);
  EXPECT_TRUE(table->doubts.empty());
}

TEST_F(PairDerivationTest, TheCellsOwnGeometryCanBeNamedInRules) {
  settings.rules = {{"world", "Arm.J_1", PairRule::Kind::ignore, ""}};
  build(std::string("geometry = [{ name = \"floor\", box_m = [6.0, 6.0, 0.1] }]\n") + kHall);
  ASSERT_TRUE(has_body("world"));
  EXPECT_EQ(state("world", "Arm.J_1.J_2"), PairState::rule_ignore);
  EXPECT_EQ(state("Part", "Arm.J_1.J_2"), PairState::tested);
  EXPECT_EQ(pair("world", "Arm.J_1")->reason, "ignored by the rule for world and Arm.J_1");
}

TEST_F(PairDerivationTest, OnlyCountsWhatNoJointMoves) {
  build(kHall);
  EXPECT_EQ(pair("Hall", "Arm"), nullptr);
  EXPECT_EQ(pair("Hall", "Part"), nullptr);
  EXPECT_EQ(table->rigid_pairs, 3U);
  EXPECT_EQ(table->pairs.size() + table->rigid_pairs, 21U);
}

TEST_F(PairDerivationTest, LeavesOutNeighboursOfOneRobotOnly) {
  build(kHall);
  EXPECT_EQ(state("Arm", "Arm.J_1"), PairState::neighbours);
  EXPECT_EQ(state("Arm.J_1.J_2", "Arm.J_1.J_2.J_3"), PairState::neighbours);
  EXPECT_EQ(pair("Arm", "Arm.J_1")->reason, "neighbours in one robot: with only the joint Arm.J_1 between them");
  // One joint between them as well, but the floor is no link of the arm.
  EXPECT_EQ(state("Hall", "Arm.J_1"), PairState::tested);
}

TEST_F(PairDerivationTest, LeavesOutWhatNeverComesNear) {
  build(kHall);
  EXPECT_EQ(state("Arm", "Arm.J_1.J_2.J_3"), PairState::tested);  // folds down upon the base
  EXPECT_EQ(state("Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4"), PairState::never);
  EXPECT_EQ(pair("Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4")->reason,
            "proved: never nearer than 0.005 m within the joint ranges");
  // Only links of one robot can be left out so: a part may be carried anywhere.
  EXPECT_EQ(state("Part", "Arm.J_1"), PairState::tested);
}

TEST_F(PairDerivationTest, LeavesOutWhatAlwaysTouches) {
  build(R"(
[[node]]
name = "Collar"
xyz_m = [0.0, 0.0, 0.5]
geometry = [{ name = "collar", cylinder_m = [0.2, 0.1] }]
[[node]]
name = "Arm"
abstract = "arm.mpc"
)");
  EXPECT_EQ(state("Collar", "Arm.J_1"), PairState::always);
  EXPECT_EQ(pair("Collar", "Arm.J_1")->reason, "proved: they touch in every posture within the joint ranges");
}

TEST_F(PairDerivationTest, TakesWhatIsConnectedAsRigidButNotAsALink) {
  build(kHall);
  EXPECT_EQ(state("Part", "Arm.J_1.J_2.J_3.J_4"), PairState::tested);
  ASSERT_TRUE(cell->connect("Part", "Arm.FLANGE", q));
  derive();
  EXPECT_EQ(pair("Part", "Arm.J_1.J_2.J_3.J_4"), nullptr);
  EXPECT_EQ(state("Part", "Arm.J_1.J_2.J_3"), PairState::tested);
  EXPECT_EQ(state("Part", "Hall"), PairState::tested);
}

TEST_F(PairDerivationTest, KeepsRobotsOnAMovingRobotApart) {
  build("[[node]]\nname = \"Sledge\"\nabstract = \"sledge.mpc\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n",
        {{"Arm", "Sledge.X"}});
  EXPECT_EQ(pair("Sledge.X", "Arm"), nullptr);  // bolted onto the sledge
  EXPECT_EQ(state("Arm", "Arm.J_1"), PairState::neighbours);
  EXPECT_EQ(state("Sledge.X", "Arm.J_1"), PairState::tested);  // one joint, but of another robot
}

TEST_F(PairDerivationTest, LetsTheLastRuleWin) {
  settings.rules = {{"Arm", "Hall", PairRule::Kind::ignore, "the floor is soft"},
                    {"Arm.J_1.J_2.J_3", "Hall", PairRule::Kind::test, ""},
                    {"Arm.J_1", "Arm", PairRule::Kind::test, ""},
                    {"Hall", "Part", PairRule::Kind::test, ""}};
  build(kHall);
  EXPECT_EQ(state("Hall", "Arm.J_1.J_2"), PairState::rule_ignore);
  EXPECT_EQ(pair("Hall", "Arm.J_1.J_2")->reason, "ignored by the rule for Arm and Hall: the floor is soft");
  EXPECT_EQ(state("Hall", "Arm.J_1.J_2.J_3.J_4"), PairState::rule_test);  // below J_3
  EXPECT_EQ(state("Arm", "Arm.J_1"), PairState::rule_test);               // neighbours, but for the rule
  EXPECT_EQ(pair("Hall", "Part"), nullptr);                               // rigid, whatever a rule says
}

TEST_F(PairDerivationTest, DoesNotTakeANameForABranch) {
  settings.rules = {{"Arm.J", "Hall", PairRule::Kind::ignore, ""}};
  build(kHall);
  EXPECT_EQ(state("Hall", "Arm.J_1"), PairState::tested);
}

TEST_F(PairDerivationTest, FollowsTheDetailLevels) {
  files->add("stand.mpc", R"(
geometry = [{ name = "leg", box_m = [0.1, 0.1, 0.5] }]
[[node]]
name = "Plate"
geometry = [{ name = "plate", box_m = [0.3, 0.3, 0.02] }]
)");
  files->add("lab.mpc", R"(
geometry = [{ name = "coarse stand", box_m = [0.4, 0.4, 0.8], stands_for = ["Stand"] }]
[[node]]
name = "Stand"
abstract = "stand.mpc"
shown = "coarse"
)");
  build("[[node]]\nname = \"Lab\"\nabstract = \"lab.mpc\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n");
  EXPECT_TRUE(has_body("Lab"));  // the coarse geometry belongs to the father
  EXPECT_FALSE(has_body("Lab.Stand"));
  ASSERT_TRUE(cell->swap_node("Lab.Stand"));
  derive();
  EXPECT_FALSE(has_body("Lab"));
  EXPECT_TRUE(has_body("Lab.Stand"));
  EXPECT_TRUE(has_body("Lab.Stand.Plate"));
  ASSERT_TRUE(cell->deactivate("Lab.Stand"));
  derive();
  EXPECT_FALSE(has_body("Lab.Stand.Plate"));
}

TEST_F(PairDerivationTest, DoubtsWhatHasNoShapeToTest) {
  build(R"(
[[node]]
name = "Thing"
geometry = [{ name = "casting", mesh = "casting.stl" }, { name = "sign", mesh = "sign.stl", collides = false }]
[[node]]
name = "Arm"
abstract = "arm.mpc"
)");
  EXPECT_FALSE(has_body("Thing"));
  ASSERT_EQ(table->doubts.size(), 1U);
  EXPECT_EQ(table->doubts[0], "Thing: casting cannot be tested for collision, because its triangles are missing");
}

TEST_F(PairDerivationTest, GivesEveryRobotOfAKindTheSameAnswers) {
  build(
      "[[node]]\nname = \"A\"\nabstract = \"arm.mpc\"\nrobot_id = \"A\"\n"
      "[[node]]\nname = \"B\"\nabstract = \"arm.mpc\"\nrobot_id = \"B\"\nxyz_m = [5.0, 0.0, 0.0]\n");
  for (const Pair& one : table->pairs) {
    const std::string& a = (*table->names)[one.a];
    const std::string& b = (*table->names)[one.b];
    if (a[0] != 'A' || b[0] != 'A') continue;
    const Pair* other = pair("B" + a.substr(1), "B" + b.substr(1));
    ASSERT_NE(other, nullptr) << a << ' ' << b;
    EXPECT_EQ(one.state, other->state) << a << ' ' << b;
    if (one.state == PairState::never) {
      EXPECT_EQ(one.reason, other->reason);
    }
  }
}

TEST_F(PairDerivationTest, SurvivesAnEmptyCell) {
  build("[[node]]\nname = \"Nothing\"\n");
  EXPECT_TRUE(table->bodies.empty());
  adopt();
  EXPECT_TRUE(check().near.empty());
  EXPECT_FALSE(sut.collides(poses));
}

}  // namespace
}  // namespace cellmirror::collision
