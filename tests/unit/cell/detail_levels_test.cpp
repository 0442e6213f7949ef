// ACTIVATE, DEACTIVATE, DELETE_NODE, SWAP_NODE, LEVEL_DOWN, LEVEL_UP: the state machine of docs/cell-files.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

// Lab.Holder carries the part Flange, whose details are flange.mpc and in it the part Bolt, whose details are bolt.mpc.
struct DetailLevels : testing::Test {
  void SetUp() override {
    files->add("lab.mpc", R"(
[[node]]
name = "Holder"
geometry = [{ name = "holder", sphere_m = 1.0 }, { name = "coarse flange", sphere_m = 1.0, stands_for = ["Flange"] }]
[[node]]
name = "Flange"
parent = "Holder"
abstract = "flange.mpc"
shown = "coarse"
[[node]]
name = "Bench"
)");
    files->add("flange.mpc", R"(
geometry = [{ name = "fine flange", sphere_m = 1.0 }, { name = "coarse bolt", sphere_m = 1.0, stands_for = ["Bolt"] }]
[[node]]
name = "Grip"
[[node]]
name = "Bolt"
abstract = "bolt.mpc"
shown = "coarse"
)");
    files->add("bolt.mpc", "geometry = [{ name = \"fine bolt\", sphere_m = 1.0 }]\n[[node]]\nname = \"Thread\"\n");
    files->add("arm.mpc", kArm);
    build(
        "[[node]]\nname = \"Lab\"\nabstract = \"lab.mpc\"\n"
        "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n"
        "[[node]]\nname = \"Plain\"\n[[node]]\nname = \"Below\"\nparent = \"Plain\"\n");
  }

  void build(const std::string& nodes) {
    Diagnostics diagnostics;
    sut = build_cell(nodes, files, diagnostics);
    ASSERT_TRUE(sut) << diagnostics.text();
  }

  // Names of the geometry that is there, sorted.
  std::vector<std::string> seen() const {
    std::vector<std::string> names;
    for (const auto& item : sut->compile()->geometry) names.push_back(item.geometry->name);
    std::ranges::sort(names);
    return names;
  }
  // E.g. "present detail".
  std::string state(const std::string& path = "Lab.Holder.Flange") const {
    const Node& node = sut->node(*sut->find(path));
    const char* shown = node.shown == Shown::detail ? "detail" : (node.shown == Shown::coarse ? "coarse" : "hidden");
    return std::string(node.content ? "present " : "absent ") + shown;
  }
  // Brings Lab.Holder.Flange into a state.
  void reach(const std::string& wanted) {
    if (wanted == "absent coarse") return;
    ASSERT_TRUE(sut->activate(kFlange));
    if (wanted == "present coarse") {
      ASSERT_TRUE(sut->swap_node(kFlange));
    }
    if (wanted == "present hidden") {
      ASSERT_TRUE(sut->deactivate(kFlange));
    }
    if (wanted == "absent hidden") {
      ASSERT_TRUE(sut->delete_node(kFlange));
    }
    ASSERT_EQ(state(), wanted);
  }

  static constexpr const char* kFlange = "Lab.Holder.Flange";
  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> sut;
};

using Seen = std::vector<std::string>;

TEST_F(DetailLevels, startsAsTheFileSays) {
  EXPECT_EQ(state(), "absent coarse");
  EXPECT_EQ(seen(), (Seen{"coarse flange", "holder"}));
  EXPECT_EQ(files->asked["flange.mpc"], 0);
}

struct Transition {
  const char* from;
  const char* operation;
  const char* to;  // empty: refused
};

struct Transitions : DetailLevels, testing::WithParamInterface<Transition> {};

TEST_P(Transitions, areThoseOfTheTable) {
  const auto [from, operation, to] = GetParam();
  reach(from);
  const auto before = sut->revision();
  const std::string name = operation;
  const Result<void> result = name == "ACTIVATE"      ? sut->activate(kFlange)
                              : name == "DEACTIVATE"  ? sut->deactivate(kFlange)
                              : name == "DELETE_NODE" ? sut->delete_node(kFlange)
                              : name == "SWAP_NODE"   ? sut->swap_node(kFlange)
                              : name == "LEVEL_DOWN"  ? sut->level_down(kFlange)
                                                      : sut->level_up(kFlange);
  if (std::string(to).empty()) {
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().what, HasSubstr("Flange"));
    EXPECT_EQ(state(), from);
    EXPECT_EQ(sut->revision(), before);
    return;
  }
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(state(), to);
  // What is seen follows from the state alone.
  const Seen expected = std::string(to).ends_with("detail")   ? Seen{"coarse bolt", "fine flange", "holder"}
                        : std::string(to).ends_with("coarse") ? Seen{"coarse flange", "holder"}
                                                              : Seen{"holder"};
  if (name != "LEVEL_DOWN" || std::string(from) != "present detail") {
    EXPECT_EQ(seen(), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Transitions,
    testing::Values(Transition{"absent coarse", "ACTIVATE", "present detail"},
                    Transition{"absent hidden", "ACTIVATE", "present detail"},
                    Transition{"present coarse", "ACTIVATE", "present detail"},
                    Transition{"present hidden", "ACTIVATE", "present detail"},
                    Transition{"present detail", "ACTIVATE", "present detail"},
                    Transition{"absent coarse", "DEACTIVATE", "absent hidden"},
                    Transition{"absent hidden", "DEACTIVATE", ""},
                    Transition{"present coarse", "DEACTIVATE", "present hidden"},
                    Transition{"present hidden", "DEACTIVATE", "present hidden"},
                    Transition{"present detail", "DEACTIVATE", "present hidden"},
                    Transition{"absent coarse", "DELETE_NODE", ""}, Transition{"absent hidden", "DELETE_NODE", ""},
                    Transition{"present coarse", "DELETE_NODE", "absent coarse"},
                    Transition{"present hidden", "DELETE_NODE", "absent hidden"},
                    Transition{"present detail", "DELETE_NODE", "absent hidden"},
                    Transition{"absent coarse", "SWAP_NODE", "present detail"},
                    Transition{"absent hidden", "SWAP_NODE", "present detail"},
                    Transition{"present coarse", "SWAP_NODE", "present detail"},
                    Transition{"present hidden", "SWAP_NODE", "present detail"},
                    Transition{"present detail", "SWAP_NODE", "present coarse"},
                    Transition{"absent coarse", "LEVEL_DOWN", "present detail"},
                    Transition{"absent hidden", "LEVEL_DOWN", "present detail"},
                    Transition{"present coarse", "LEVEL_DOWN", "present detail"},
                    Transition{"present hidden", "LEVEL_DOWN", "present detail"},
                    Transition{"present detail", "LEVEL_DOWN", "present detail"},  // the bolt comes up
                    Transition{"absent coarse", "LEVEL_UP", ""}, Transition{"absent hidden", "LEVEL_UP", ""},
                    Transition{"present coarse", "LEVEL_UP", ""}, Transition{"present hidden", "LEVEL_UP", ""},
                    Transition{"present detail", "LEVEL_UP", "present coarse"}));

TEST_F(DetailLevels, levelDownGoesOneLayerAtATimeAndLevelUpTakesItBack) {
  ASSERT_TRUE(sut->level_down("Lab.Holder"));
  EXPECT_EQ(seen(), (Seen{"coarse bolt", "fine flange", "holder"}));
  ASSERT_TRUE(sut->level_down("Lab.Holder"));
  EXPECT_EQ(seen(), (Seen{"fine bolt", "fine flange", "holder"}));
  const auto deepest = sut->level_down("Lab.Holder");
  ASSERT_FALSE(deepest);
  EXPECT_THAT(deepest.error().what, HasSubstr("full detail"));
  ASSERT_TRUE(sut->level_up("Lab.Holder"));
  EXPECT_EQ(seen(), (Seen{"coarse bolt", "fine flange", "holder"}));
  ASSERT_TRUE(sut->level_up("Lab.Holder"));
  EXPECT_EQ(seen(), (Seen{"coarse flange", "holder"}));
  EXPECT_FALSE(sut->level_up("Lab.Holder"));
}

TEST_F(DetailLevels, levelDownLoadsAllOrNothing) {
  files->add("lab.mpc", R"(
geometry = [{ sphere_m = 1.0, stands_for = ["A", "B"] }]
[[node]]
name = "A"
abstract = "bolt.mpc"
shown = "coarse"
[[node]]
name = "B"
abstract = "gone.mpc"
shown = "coarse"
)");
  build("[[node]]\nname = \"Lab\"\nabstract = \"lab.mpc\"\n");
  const auto nodes = sut->node_count();
  const auto result = sut->level_down("Lab");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("gone.mpc"));
  EXPECT_EQ(state("Lab.A"), "absent coarse");
  EXPECT_EQ(sut->node_count(), nodes);
}

TEST_F(DetailLevels, aCoarseBodyForSeveralPartsStaysUntilAllAreInDetail) {
  files->add("lab.mpc", R"(
geometry = [{ name = "block", sphere_m = 1.0, stands_for = ["A", "B"] }]
[[node]]
name = "A"
abstract = "bolt.mpc"
shown = "coarse"
[[node]]
name = "B"
abstract = "bolt.mpc"
shown = "coarse"
)");
  build("[[node]]\nname = \"Lab\"\nabstract = \"lab.mpc\"\n");
  ASSERT_TRUE(sut->swap_node("Lab.A"));
  EXPECT_EQ(seen(), (Seen{"block", "fine bolt"}));
  ASSERT_TRUE(sut->swap_node("Lab.B"));
  EXPECT_EQ(seen(), (Seen{"fine bolt", "fine bolt"}));
}

TEST_F(DetailLevels, deactivatingABranchHidesWhatIsBelowAndKeepsItsStates) {
  ASSERT_TRUE(sut->activate(kFlange));
  ASSERT_TRUE(sut->deactivate("Lab"));
  EXPECT_EQ(seen(), Seen{});
  EXPECT_FALSE(sut->visible(*sut->find("Lab.Holder.Flange.Grip")));
  EXPECT_TRUE(sut->knows("Lab.Holder.Flange.Grip")) << "not erased";
  const auto below = sut->activate(kFlange);
  ASSERT_FALSE(below);
  EXPECT_EQ(below.error().remedy, "ACTIVATE Lab first");
  ASSERT_TRUE(sut->activate("Lab"));
  EXPECT_EQ(seen(), (Seen{"coarse bolt", "fine flange", "holder"}));
}

TEST_F(DetailLevels, nodesWithoutAbstractFileAreRefusedWithTheReason) {
  for (const auto& result :
       {sut->activate("Plain"), sut->swap_node("Plain"), sut->level_down("Plain"), sut->level_up("Plain")}) {
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().what, HasSubstr("ABSTRACT"));
  }
  ASSERT_TRUE(sut->deactivate("Plain"));
  EXPECT_TRUE(sut->activate("Plain")) << "it is in memory and was deactivated";
}

TEST_F(DetailLevels, nodesWithoutFatherGeometryCannotBeSwapped) {
  const auto result = sut->swap_node("Lab");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("father geometry"));
  EXPECT_FALSE(sut->level_up("Lab")) << "nothing could replace it";
}

TEST_F(DetailLevels, aCarriedPartIsNotReplacedByGeometryThatStaysBehind) {
  ASSERT_TRUE(sut->activate(kFlange));
  ASSERT_TRUE(sut->connect(kFlange, "Arm.TIP", sut->start_positions()));
  for (const auto& result : {sut->swap_node(kFlange), sut->level_up("Lab.Holder")}) {
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().what, HasSubstr("is attached to Arm.LIFT.TURN.BEND.TIP"));
  }
}

TEST_F(DetailLevels, aPartShownCoarselyCannotBeCarriedAway) {
  const auto result = sut->connect(kFlange, "Arm.TIP", sut->start_positions());
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().remedy, HasSubstr("SWAP_NODE Lab.Holder.Flange"));
}

TEST_F(DetailLevels, deletingReturnsTheMemoryAndKeepsTheNodeForLoadingAgain) {
  ASSERT_TRUE(sut->activate(kFlange));
  const auto with = sut->node_count();
  const std::weak_ptr<const Component> content = sut->node(*sut->find(kFlange)).content;
  ASSERT_TRUE(sut->delete_node(kFlange));
  EXPECT_EQ(sut->node_count(), with - 2);
  EXPECT_FALSE(sut->knows("Lab.Holder.Flange.Grip"));
  EXPECT_TRUE(sut->knows(kFlange));
  static_cast<void>(sut->compile());  // the last picture held the geometry
  EXPECT_TRUE(content.expired());
  ASSERT_TRUE(sut->activate(kFlange));
  EXPECT_EQ(files->asked["flange.mpc"], 2);
  EXPECT_TRUE(sut->knows("Lab.Holder.Flange.Grip"));
  EXPECT_EQ(sut->node_count(), with);
}

TEST_F(DetailLevels, aPartThatWasDeletedComesBackAsItsFilesHaveIt) {
  const auto q = sut->start_positions();
  const NodeId flange = *sut->find(kFlange);
  const Pose X_WF = sut->world_pose(flange, q);
  Pose moved = Pose::Identity();
  moved.translation() = Eigen::Vector3d(1, 2, 3);
  reach("present detail");
  ASSERT_TRUE(sut->set_placement(kFlange, moved));
  ASSERT_TRUE(sut->connect(kFlange, "Lab.Bench", q));
  ASSERT_TRUE(sut->delete_node(kFlange));
  ASSERT_TRUE(sut->activate(kFlange));
  EXPECT_TRUE(sut->world_pose(flange, q).isApprox(X_WF));
  EXPECT_EQ(sut->path(sut->node(flange).predecessor), "Lab.Holder");
  // A later PLACEMENT counts, whether the part is in memory or not.
  ASSERT_TRUE(sut->delete_node(kFlange));
  ASSERT_TRUE(sut->set_placement(kFlange, moved));
  ASSERT_TRUE(sut->activate(kFlange));
  EXPECT_TRUE(sut->world_pose(flange, q).isApprox(moved));
}

TEST_F(DetailLevels, aMovedPartIsNotDeletedUnderWhatHangsOnIt) {
  const auto q = sut->start_positions();
  reach("present detail");
  ASSERT_TRUE(sut->connect("Plain", kFlange, q));
  Pose moved = Pose::Identity();
  moved.translation().x() = 1;
  ASSERT_TRUE(sut->set_placement(kFlange, moved));
  const auto refused = sut->delete_node(kFlange);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("Plain is attached to Lab.Holder.Flange"));
  EXPECT_EQ(state(), "present detail");
  ASSERT_TRUE(sut->connect("Plain", "Lab.Bench", q));
  EXPECT_TRUE(sut->delete_node(kFlange));
}

TEST_F(DetailLevels, deletingAPlainNodeErasesItForGood) {
  ASSERT_TRUE(sut->delete_node("Plain"));
  EXPECT_FALSE(sut->knows("Plain"));
  EXPECT_FALSE(sut->knows("Below"));
}

TEST_F(DetailLevels, deletingIsRefusedWhereSomethingElseHangsOnTheBranch) {
  ASSERT_TRUE(sut->connect("Plain", "Arm.TIP", sut->start_positions()));
  const auto result = sut->delete_node("Arm");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("Plain is attached to Arm.LIFT.TURN.BEND.TIP"));
  EXPECT_TRUE(sut->knows("Arm.TIP"));
  EXPECT_NE(sut->robot("ARM"), nullptr);
}

TEST_F(DetailLevels, deletingARobotThatIsOnLineIsRefused) {
  sut->set_online_query([](std::string_view id) { return id == "ARM"; });
  const auto result = sut->delete_node("Arm");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().remedy, "ROBOT ARM offline first");
}

TEST_F(DetailLevels, aDeletedRobotComesBackInItsSlot) {
  const auto slot = sut->robot("ARM")->slot();
  ASSERT_TRUE(sut->delete_node("Arm"));
  EXPECT_EQ(sut->robot("ARM"), nullptr);
  EXPECT_TRUE(sut->robot_ids().empty());
  ASSERT_TRUE(sut->activate("Arm"));
  ASSERT_NE(sut->robot("ARM"), nullptr);
  EXPECT_EQ(sut->robot("ARM")->slot(), slot);
}

TEST_F(DetailLevels, partsOfARobotAreNotDeletedAlone) {
  const auto result = sut->delete_node("Arm.BEND");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("part of the robot ARM"));
}

TEST_F(DetailLevels, aComponentThatContainsItselfIsRefused) {
  files->add("bolt.mpc", "[[node]]\nname = \"Again\"\nabstract = \"flange.mpc\"\nshown = \"hidden\"\n");
  ASSERT_TRUE(sut->activate(kFlange));
  ASSERT_TRUE(sut->activate("Lab.Holder.Flange.Bolt"));
  const auto result = sut->activate("Again");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("contain itself"));
}

TEST_F(DetailLevels, aSecondRobotOfOneNameIsRefusedAndNothingIsLoaded) {
  files->add("lab.mpc", "[[node]]\nname = \"Second\"\nabstract = \"arm.mpc\"\nshown = \"hidden\"\n");
  build("[[node]]\nname = \"Lab\"\nabstract = \"lab.mpc\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n");
  const auto result = sut->activate("Second");
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("two robots ARM"));
  EXPECT_EQ(state("Second"), "absent hidden");
}

TEST_F(DetailLevels, anUnreadableFileIsRefusedWithItsReason) {
  files->remove("flange.mpc");
  const auto result = sut->activate(kFlange);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().what, HasSubstr("flange.mpc"));
  EXPECT_EQ(state(), "absent coarse");
}

}  // namespace
}  // namespace cellmirror
