// Deforming objects in a scene: passed through, drawn as SCRIPT says, their network's forces, axes and legend.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "rt_core/ports/palette.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/scene/scene_builder.hpp"
#include "rt_core/scene/words.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

class TissueTest : public ::testing::Test {
 protected:
  TissueTest() {
    view_.surfaces.resize(2);
    view_.surfaces[0].name = "liver";
    view_.surfaces[1].name = "gallbladder";
  }
  const Scene& build() {
    input_.cell = &cell_.cell;
    input_.poses = &cell_.poses;
    input_.display = &cell_.display;
    input_.tissue = std::make_shared<const TissueView>(view_);
    input_.now = Timestamp{10'000'000'000};
    sut_.build(input_, scene_);
    return scene_;
  }
  void show_network() {
    view_.network.nodes = {{0, 0, 0}, {0.03F, 0, 0}, {0, 0.04F, 0}};
    view_.network.kinds = {TissueNodeKind::inner, TissueNodeKind::contact, TissueNodeKind::fixed};
    view_.network.forces = {{Eigen::Vector3f(0.03F, 0, 0), Eigen::Vector3f(0, 0, 2)},
                            {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(-1, 0, 0)}};
    view_.network.central_nodes.assign(2, Pose::Identity());
    view_.network.central_nodes[1].translation().x() = 0.1;
  }
  [[nodiscard]] bool legend_has(const std::string& text) const {
    return std::ranges::any_of(scene_.legend, [&](const LegendEntry& entry) { return entry.text == text; });
  }

  SmallCell cell_;
  TissueView view_;
  SceneInput input_;
  Scene scene_;
  SceneBuilder sut_;
};

TEST_F(TissueTest, TheViewIsSharedWithTheScene) {
  build();
  EXPECT_EQ(scene_.tissue, input_.tissue);
  input_.tissue = nullptr;
  sut_.build(input_, scene_);
  EXPECT_EQ(scene_.tissue, nullptr);
  EXPECT_TRUE(scene_.tissue_modes.empty());
}

TEST_F(TissueTest, ObjectsAreDrawnAsTheLastRuleSays) {
  cell_.display.draw_rules = {{"", true, DrawMode::flat}, {"liver", false, DrawMode::wireframe}};
  build();
  EXPECT_EQ(scene_.tissue_modes, (std::vector{DrawMode::wireframe, DrawMode::flat}));
  cell_.display.draw_rules.push_back({"", true, DrawMode::gouraud});
  build();
  EXPECT_EQ(scene_.tissue_modes, (std::vector{DrawMode::gouraud, DrawMode::gouraud}));
}

TEST_F(TissueTest, ForcesHaveOneScaleThatTheLegendTells) {
  show_network();
  build();
  ASSERT_EQ(scene_.arrows.size(), 2U);
  EXPECT_NEAR(scene_.arrows[0].along.norm() / scene_.arrows[1].along.norm(), 2, 1e-9);
  EXPECT_GT(scene_.arrows[0].along.z(), 0.001);
  EXPECT_LE(scene_.arrows[0].along.z(), 0.016);  // of an object of 50 mm
  EXPECT_LT((scene_.arrows[0].from - Eigen::Vector3d(0.03, 0, 0)).norm(), 1e-6);
  const double newton_per_metre = 2 / scene_.arrows[0].along.norm();
  EXPECT_TRUE(legend_has("force on tissue, 10 mm = " + quantity_text(0.01 * newton_per_metre, "N")));
}

TEST_F(TissueTest, CentralNodesHaveAxesWithTheNamesOfTheirObjects) {
  show_network();
  build();
  ASSERT_EQ(scene_.axes.size(), 2U);
  EXPECT_EQ(scene_.axes[1].name, "gallbladder");
  EXPECT_EQ(scene_.axes[1].X_WF.translation().x(), 0.1);
  EXPECT_NEAR(scene_.axes[0].length_m, 0.006, 1e-6);
  view_.network.central_nodes.pop_back();
  build();
  EXPECT_EQ(scene_.axes.at(0).name, "");
}

TEST_F(TissueTest, TheLegendHasTheKindsOfNodesThatOccur) {
  show_network();
  build();
  EXPECT_TRUE(legend_has("inner node"));
  EXPECT_TRUE(legend_has("node in contact"));
  EXPECT_TRUE(legend_has("fixed node"));
  EXPECT_FALSE(legend_has("outer node"));
  const auto contact = std::ranges::find(scene_.legend, "node in contact", &LegendEntry::text);
  EXPECT_EQ(contact->rgba, palette::kContactNode);
  cell_.display.legend = false;
  EXPECT_TRUE(build().legend.empty());
  cell_.display.legend = true;
  view_.network = {};
  build();
  EXPECT_TRUE(scene_.legend.empty());
  EXPECT_TRUE(scene_.arrows.empty());
  EXPECT_TRUE(scene_.axes.empty());
}

TEST_F(TissueTest, WhatIsNotFiniteIsLeftOut) {
  show_network();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  view_.network.nodes.push_back({kNan, 0, 0});
  view_.network.forces.push_back({Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(kNan, 0, 0)});
  view_.network.forces.push_back({Eigen::Vector3f(kNan, 0, 0), Eigen::Vector3f(1, 0, 0)});
  view_.network.central_nodes[0].translation().x() = std::numeric_limits<double>::infinity();
  build();
  EXPECT_EQ(scene_.arrows.size(), 2U);
  EXPECT_EQ(scene_.axes.size(), 1U);
  view_.network.nodes.assign(3, {kNan, 0, 0});
  build();
  EXPECT_TRUE(scene_.arrows.empty());
}

}  // namespace
}  // namespace cellmirror::scene
