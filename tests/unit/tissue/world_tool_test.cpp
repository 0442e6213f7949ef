// What instruments do: grip, clip, cut, coagulate, rinse.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/tissue/world_scene.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

constexpr std::uint8_t kClamp = static_cast<std::uint8_t>(TissueLimitAction::clamp);

ObjectDescription with_artery(ObjectDescription d, VesselKind kind = VesselKind::artery) {
  d.vessels.push_back(
      {.name = "artery", .kind = kind, .radius_m = 0.0015, .centre_line = {{-0.02, 0, -0.004}, {0.02, 0, -0.004}}});
  return d;
}

std::string part(const TissueEvent& event) { return event.part.data(); }

TEST(WorldGrip, lifts_a_free_body_and_feels_its_weight) {
  ObjectDescription d = block("lump", {0.024, 0.024, 0.024}, false);
  d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  d.material.damping_s = 1e-3;
  Scene scene({d});
  const double weight = 9.81 * 1000 * scene.state().objects[0].volume_m3;
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.instrument(0, downwards({0, 0, 0.0005}), 1.0);
  scene.step();
  EXPECT_EQ(scene.response(0).held, 0U);
  scene.instrument(0, downwards({0, 0, 0.0005}), 0.0);
  scene.step();
  EXPECT_GT(scene.response(0).held, 0U);
  EXPECT_EQ(scene.count(TissueEventKind::grip), 1);
  scene.move(0, {0, 0, 0.01}, 0.02);
  scene.steps(1500);
  Vector3d mean = Vector3d::Zero();
  for (int i = 0; i < 500; ++i) {
    scene.step();
    mean += scene.response(0).force_W / 500;
  }
  EXPECT_NEAR(mean.z(), -weight, 0.05 * weight);
  scene.instrument(0, downwards({0, 0, 0.01}), 1.0);
  scene.step();
  EXPECT_EQ(scene.response(0).held, 0U);
  EXPECT_EQ(scene.count(TissueEventKind::release), 1);
  EXPECT_NEAR(scene.state().events.back().value, weight, 0.3 * weight) << "the force that the jaws held, in N";
  scene.steps(100);
  const TissueView view = scene.view();
  EXPECT_LT(view.surfaces[0].vertices[0].z(), 0.0F) << "it falls";
}

TEST(WorldGrip, slips_beyond_the_limit_of_force) {
  Scene scene({block("liver", {0.05, 0.05, 0.02})});
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.world().apply(SetLimit{TissueLimit::grip_force, kClamp, 0.05});
  scene.instrument(0, downwards({0, 0, 0.0005}), 0.0);
  scene.step();
  const auto held = scene.response(0).held;
  ASSERT_GT(held, 0U);
  double most = 0;
  for (int i = 0; i < 2000 && scene.response(0).held > 0; ++i) {
    scene.instrument(0, downwards({0, 0, 0.0005 + 0.00002 * i}), 0.0);
    scene.step();
    most = std::max(most, scene.response(0).force_W.norm());
  }
  EXPECT_EQ(scene.response(0).held, 0U);
  EXPECT_LE(most, 0.05 * held * 1.05);
  EXPECT_EQ(scene.count(TissueEventKind::slip), 1);
  EXPECT_EQ(scene.count(TissueEventKind::release), 1);
  EXPECT_GT(scene.state().excesses[3], 0U);
}

TEST(WorldGrip, two_graspers_that_pull_one_organ_apart_stay_stable) {
  Scene scene({block("gut", {0.06, 0.02, 0.016}, false)});
  for (const int slot : {0, 1}) scene.world().apply(acts_below(slot, InstrumentKind::gripper));
  const double x = 0.022;
  scene.instrument(0, downwards({-x, 0, 0.0005}), 0.0);
  scene.instrument(1, downwards({x, 0, 0.0005}), 0.0);
  scene.step();
  ASSERT_GT(scene.response(0).held, 0U);
  ASSERT_GT(scene.response(1).held, 0U);
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    const double pulled = std::min(0.05, 0.00002 * i);
    scene.instrument(0, downwards({-x - pulled, 0, 0.0005}), 0.0);
    scene.instrument(1, downwards({x + pulled, 0, 0.0005}), 0.0);
    scene.step();
    if (i % 50 == 0) {
      ASSERT_TRUE(finite(scene.view())) << i;
    }
    most = std::max({most, scene.response(0).force_W.norm(), scene.response(1).force_W.norm()});
  }
  EXPECT_LT(most, 30) << "N";
  EXPECT_GT(most, 0.1);
  EXPECT_LT(scene.state().objects[0].energy_j, 1.0);
  for (const int slot : {0, 1}) scene.instrument(slot, downwards({slot == 0 ? -0.2 : 0.2, 0, 0.1}), 1.0);
  scene.steps(3000);
  EXPECT_LT(scene.state().objects[0].energy_j, 1e-4) << "back to its shape";
}

// A tube of 5 mm along x that is held at its ends.
ObjectDescription tube() {
  ObjectDescription d = block("duct", {0.05, 0.005, 0.005}, false);
  d.element_size_m = 0.004;
  d.fixed.push_back({.low = {-1, -1, -1}, .high = {-0.02, 1, 1}});
  d.fixed.push_back({.low = {0.02, -1, -1}, .high = {1, 1, 1}});
  d.vessels.push_back({.name = "artery", .radius_m = 0.0015, .centre_line = {{-0.02, 0, -0.0025}, {0.02, 0, -0.0025}}});
  return d;
}

TEST(WorldTool, scissors_cut_progressively_and_sever_a_vessel_that_bleeds_until_it_is_clipped) {
  Scene scene({tube()});
  scene.world().apply(acts_below(0, InstrumentKind::scissors));
  scene.world().apply(SetEffect{TissueEffect::bleeding, true});
  // The blades open along y, about the duct, at x = 5 mm.
  scene.instrument(0, downwards({0.005, 0, 0.004}), 1.0);
  scene.world().apply(SetInstrumentShape{0, {.effector_radius_m = 0.006}});
  scene.step();
  scene.move(0, {0.005, 0, -0.008}, 0.1);
  scene.steps(20);
  const TissueState before = scene.state();
  EXPECT_FALSE(before.vessels[0].severed);
  scene.instrument(0, downwards({0.005, 0, -0.008}), 0.0);
  int steps_of_cut = 0;
  std::uint32_t elements = before.objects[0].elements;
  for (int i = 0; i < 120; ++i) {
    scene.step();
    const std::uint32_t now = scene.state().objects[0].elements;
    steps_of_cut += now > elements ? 1 : 0;
    elements = now;
  }
  EXPECT_GT(elements, before.objects[0].elements);
  EXPECT_GT(steps_of_cut, 1) << "the front moves from the pivot to the tip";
  EXPECT_NEAR(scene.state().objects[0].volume_m3, before.objects[0].volume_m3, 1e-6 * before.objects[0].volume_m3);
  TissueState state = scene.state();
  ASSERT_TRUE(state.vessels[0].severed);
  EXPECT_GT(state.vessels[0].bleeding_ml_min, 10);
  EXPECT_GT(scene.count(TissueEventKind::cut), 0);
  EXPECT_EQ(scene.count(TissueEventKind::bleed), 1);
  EXPECT_GT(scene.view().particles.size(), 0U);
  scene.steps(300);
  state = scene.state();
  EXPECT_GT(state.blood_loss_ml, 0.1);
  // A clip upstream, at x = -10 mm.
  scene.world().apply(acts_below(1, InstrumentKind::clip_applicator));
  scene.world().apply(SetClip{1, {.name = "clip", .shape = box_surface({-0.001, -0.001, 0}, {0.001, 0.001, 0.009})}});
  scene.instrument(1, downwards({-0.01, 0, 0.002}), 1.0);
  scene.step();
  scene.move(1, {-0.01, 0, -0.001}, 0.05);
  scene.instrument(1, downwards({-0.01, 0, -0.001}), 0.0);
  scene.steps(5);
  ASSERT_EQ(scene.count(TissueEventKind::clip), 1);
  for (const TissueEvent& event : scene.events()) {
    if (event.kind == TissueEventKind::clip) {
      EXPECT_EQ(part(event), "artery");
    }
  }
  scene.steps(4500);  // the far end runs empty
  state = scene.state();
  EXPECT_EQ(state.vessels[0].clips, 1U);
  EXPECT_EQ(state.vessels[0].bleeding_ml_min, 0);
  EXPECT_EQ(scene.count(TissueEventKind::bleed_end), 1);
  ASSERT_EQ(scene.view().clips.size(), 1U);
  EXPECT_TRUE(scene.view().clips[0].closes_vessel);
  EXPECT_EQ(scene.view().clips[0].vertices->size(), 8U);
}

TEST(WorldTool, a_clip_follows_the_tissue) {
  Scene scene({with_artery(block("duct", {0.05, 0.024, 0.016}, false))});
  scene.world().apply(acts_below(1, InstrumentKind::clip_applicator));
  scene.instrument(1, downwards({0, 0, 0.001}), 0.0);
  scene.step();
  ASSERT_EQ(scene.view().clips.size(), 1U);
  EXPECT_LT((scene.view().clips[0].X_WC.translation() - Vector3d(0, 0, -0.004)).norm(), 0.006);
  const Vector3d before = scene.view().clips[0].X_WC.translation();
  scene.remove_instrument(1);
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.instrument(0, downwards({0.01, 0, 0.0005}), 0.0);
  scene.step();
  ASSERT_GT(scene.response(0).held, 0U);
  scene.move(0, {0.01, 0, 0.0305}, 0.02);
  scene.steps(1500);
  EXPECT_NEAR(scene.view().clips[0].X_WC.translation().z() - before.z(), 0.03, 0.008);
}

TEST(WorldTool, nothing_within_reach_takes_no_clip) {
  Scene scene({with_artery(block("duct", {0.05, 0.024, 0.016}))});
  scene.world().apply(acts_below(1, InstrumentKind::clip_applicator));
  scene.instrument(1, downwards({0, 0, 0.05}), 0.0);
  scene.steps(5);
  EXPECT_EQ(scene.count(TissueEventKind::clip), 0);
}

TEST(WorldTool, a_hot_hook_burns_smokes_and_cuts_where_it_moves_long_enough) {
  Scene scene({block("liver", {0.04, 0.04, 0.016})});
  scene.world().apply(acts_below(0, InstrumentKind::hook));
  scene.instrument(0, along_x({0.004, 0, 0.0005}), 1.0);
  scene.steps(50);
  EXPECT_EQ(scene.state().smoke, 0);
  for (int i = 0; i < 1500; ++i) {
    scene.instrument(0, along_x({0.004, 0.006 * std::sin(0.006 * i), 0.0005 - 0.000004 * i}), 0.0);
    scene.step();
  }
  TissueState state = scene.state();
  EXPECT_GT(state.objects[0].coagulated_share, 0.001);
  EXPECT_GT(state.smoke, 0.1);
  EXPECT_GT(state.lens_fog, 0.001);
  EXPECT_EQ(scene.count(TissueEventKind::coagulate), 1) << "its start";
  float burnt = 0;
  const TissueView burning = scene.view();
  for (const float burn : burning.surfaces[0].burn) burnt = std::max(burnt, burn);
  EXPECT_GT(burnt, 1.0F);
  EXPECT_GT(state.objects[0].elements, state.objects[0].elements_at_start);
  scene.instrument(0, along_x({0.004, 0, 0.02}), 1.0);
  scene.steps(20);
  EXPECT_EQ(scene.count(TissueEventKind::coagulate), 2) << "and its end";
  EXPECT_GT(scene.events().back().value, 0);
  scene.world().apply(CleanLens{});
  EXPECT_EQ(scene.state().lens_fog, 0);
}

TEST(WorldTool, a_stroke_that_another_tool_interrupts_is_reported_as_ended) {
  Scene scene({block("liver", {0.04, 0.04, 0.016})});
  scene.world().apply(acts_below(0, InstrumentKind::forceps));
  scene.instrument(0, along_x({0.004, 0, 0.001}), 0.0);
  scene.steps(500);
  EXPECT_EQ(scene.count(TissueEventKind::coagulate), 1);
  InstrumentAction off = {.kind = InstrumentKind::forceps, .test = InstrumentTest::off};
  scene.world().apply(SetInstrumentAction{0, off});
  scene.steps(2);
  EXPECT_EQ(scene.count(TissueEventKind::coagulate), 2);
  EXPECT_GT(scene.events().back().value, 0);
  const double burnt = scene.state().objects[0].coagulated_share;
  scene.steps(200);
  EXPECT_EQ(scene.state().objects[0].coagulated_share, burnt);
  EXPECT_EQ(scene.count(TissueEventKind::coagulate), 2);
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.steps(2);
  EXPECT_EQ(scene.count(TissueEventKind::grip), 1);
}

TEST(WorldTool, forceps_coagulate_without_cutting) {
  Scene scene({block("liver", {0.04, 0.04, 0.016})});
  scene.world().apply(acts_below(0, InstrumentKind::forceps));
  scene.instrument(0, along_x({0.004, 0, 0.001}), 0.0);
  scene.steps(1500);
  const TissueState state = scene.state();
  EXPECT_GT(state.objects[0].coagulated_share, 0.001);
  EXPECT_EQ(state.objects[0].elements, state.objects[0].elements_at_start);
}

TEST(WorldTool, objects_without_the_attribute_are_not_changed) {
  for (const auto& [kind, attribute] : {std::pair(InstrumentKind::gripper, TissueAttribute::grasp),
                                        std::pair(InstrumentKind::scissors, TissueAttribute::cut),
                                        std::pair(InstrumentKind::forceps, TissueAttribute::coagulate),
                                        std::pair(InstrumentKind::clip_applicator, TissueAttribute::clip)}) {
    Scene scene({with_artery(block("liver", {0.04, 0.04, 0.016}))});
    scene.world().apply(SetAttributes{-1, static_cast<std::uint16_t>(attribute), 0});
    scene.world().apply(acts_below(0, kind));
    scene.instrument(0, downwards({0, 0, -0.001}), 0.0);
    scene.steps(200);
    const TissueState state = scene.state();
    EXPECT_EQ(scene.response(0).held, 0U);
    EXPECT_EQ(state.objects[0].elements, state.objects[0].elements_at_start);
    EXPECT_EQ(state.objects[0].coagulated_share, 0);
    EXPECT_EQ(scene.view().clips.size(), 0U);
  }
}

TEST(WorldTool, suction_and_irrigation_move_the_level_and_the_colour) {
  ObjectDescription bed = block("bed", {0.04, 0.04, 0.016});
  bed.pools.push_back({.size_m = {0.1, 0.1}, .level_m = 0.005});
  bed.X_WO.translation().z() = -0.05;
  Scene scene({bed});
  scene.instrument(3, downwards({0, 0.03, -0.046}), 1.0);
  scene.world().apply(SetEffect{TissueEffect::pool_ripples, true});
  scene.world().apply(SetEffect{TissueEffect::suction, true, 3});
  scene.steps(500);
  TissueView view = scene.view();
  ASSERT_TRUE(view.pool.present);
  EXPECT_NEAR(view.pool.level_m, 0.005 - 0.5 * 30e-6 / 0.01, 1e-6);
  float highest = 0;
  for (const float h : view.pool.heights_m) highest = std::max(highest, std::abs(h));
  EXPECT_GT(highest, 1e-6F) << "ripples";
  scene.world().apply(SetEffect{TissueEffect::suction, false, 3});
  scene.world().apply(SetEffect{TissueEffect::irrigation, true, 3});
  scene.steps(1000);
  scene.world().apply(SetEffect{TissueEffect::irrigation, false, 3});
  scene.steps(2000);
  EXPECT_NEAR(scene.view().pool.level_m, 0.005 - 0.0015 + 10e-6 / 0.01, 5e-5);
  scene.world().apply(ResetPool{});
  EXPECT_EQ(scene.view().pool.level_m, 0.005);
}

}  // namespace
}  // namespace cellmirror::tissue
