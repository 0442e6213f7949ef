// The model as a whole: connections, vessels, limits, resets, the same from run to run.
#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/tissue/effects/vessels.hpp"
#include "tests/unit/tissue/world_scene.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

constexpr std::uint8_t bit(TissueLimitAction action) { return static_cast<std::uint8_t>(action); }

TEST(Vessels, a_pulse_comes_once_a_period_and_rests_between) {
  EXPECT_EQ(pulse_wave(0), 0);
  EXPECT_NEAR(pulse_wave(0.5 * 0.35 * kPulsePeriod_s), 1, 1e-12);
  EXPECT_EQ(pulse_wave(0.5 * kPulsePeriod_s), 0);
  EXPECT_NEAR(pulse_wave(0.1), pulse_wave(0.1 + 3 * kPulsePeriod_s), 1e-9);
  EXPECT_NEAR(pulse_wave(-0.1), pulse_wave(kPulsePeriod_s - 0.1), 1e-9);
}

TEST(Vessels, a_blade_crosses_a_segment_only_within_its_parallelogram) {
  const BladeSweep blade{.corner = {0, 0, 0}, .along = {2, 0, 0}, .across = {1, 1, 0}};
  EXPECT_NEAR(crossing(blade, {1.5, 0.5, 1}, {1.5, 0.5, -3}).value(), 0.25, 1e-12);
  EXPECT_FALSE(crossing(blade, {0.2, 0.5, 1}, {0.2, 0.5, -1})) << "beside the slanted edge";
  EXPECT_FALSE(crossing(blade, {1.5, 0.5, 1}, {1.5, 0.5, 0.1})) << "does not reach it";
  EXPECT_FALSE(crossing(blade, {1, 0.5, 0}, {2, 0.5, 0})) << "in its plane";
}

Connection ligament(double stiffness, double tear) {
  return {.name = "ligament",
          .object_a = "lump",
          .object_b = "",
          .point_a = {0, 0, 0},
          .point_b = {0, 0, 0.05},
          .stiffness_n_m = stiffness,
          .tear_force_n = tear};
}

TEST(Connections, carry_a_weight_by_their_stretch) {
  ObjectDescription d = block("lump", {0.024, 0.024, 0.024}, false);
  d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  d.material.youngs_modulus_pa = 10000;
  for (const double stiffness : {40.0, 1e5}) {
    Scene scene({d}, {ligament(stiffness, 0)});
    const double weight = 9.81 * 1000 * scene.state().objects[0].volume_m3;
    // The mean height of the block falls by the spring's stretch and its own.
    scene.steps(6000);
    const TissueState state = scene.state();
    EXPECT_EQ(state.connections, 1U);
    EXPECT_EQ(state.connections_torn, 0U);
    float highest = -1;
    const TissueView hanging = scene.view();
    for (const Eigen::Vector3f& p : hanging.surfaces[0].vertices) highest = std::max(highest, p.z());
    EXPECT_NEAR(static_cast<double>(highest), -weight / stiffness, 0.0015);
  }
}

TEST(Connections, tear_beyond_their_force_and_come_back_with_the_model) {
  ObjectDescription d = block("lump", {0.024, 0.024, 0.024}, false);
  d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  Scene scene({d}, {ligament(100, 0.05)});
  scene.steps(500);
  EXPECT_EQ(scene.state().connections_torn, 1U);
  ASSERT_EQ(scene.count(TissueEventKind::tear), 1);
  EXPECT_STREQ(scene.events().front().part.data(), "ligament");
  scene.world().apply(ResetModel{});
  EXPECT_EQ(scene.state().connections_torn, 0U);
}

TEST(Connections, of_objects_that_are_not_there_are_refused) {
  const Result<World> made =
      World::make({block("lump", {0.024, 0.024, 0.024})}, {{.name = "x", .object_a = "lung", .object_b = ""}});
  ASSERT_FALSE(made.has_value());
  EXPECT_NE(made.error().text().find("lung"), std::string::npos);
}

TEST(WorldModel, a_pulse_is_felt) {
  ObjectDescription d = block("liver", {0.05, 0.03, 0.016});
  d.vessels.push_back({.name = "artery", .radius_m = 0.002, .centre_line = {{-0.02, 0, -0.004}, {0.02, 0, -0.004}}});
  d.material.damping_s = 1e-3;
  Scene scene({d});
  scene.instrument(0, downwards({0, 0, 0.001}));
  scene.move(0, {0, 0, -0.001}, 0.02);
  scene.steps(500);
  const auto range = [&] {
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < 900; ++i) {
      scene.step();
      low = std::min(low, scene.response(0).force_W.z());
      high = std::max(high, scene.response(0).force_W.z());
    }
    return high - low;
  };
  const double still = range();
  scene.world().apply(SetEffect{TissueEffect::pulse, true});
  const double beating = range();
  EXPECT_GT(beating, 3 * still);
  EXPECT_GT(beating, 0.002) << "N";
}

// Touch, grip, cut, burn, clip and bleed.
void play(Scene& scene) {
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.world().apply(acts_below(1, InstrumentKind::scissors));
  scene.world().apply(acts_below(2, InstrumentKind::hook));
  scene.world().apply(SetEffect{TissueEffect::bleeding, true});
  scene.world().apply(SetEffect{TissueEffect::pool_ripples, true});
  for (int i = 0; i < 400; ++i) {
    const double t = 0.001 * i;
    scene.instrument(0, downwards({-0.012, 0, 0.001 + 0.01 * std::max(0.0, t - 0.1)}), i > 20 ? 0.0 : 1.0);
    scene.instrument(1, downwards({0.008, 0, 0.002 - 0.04 * std::min(t, 0.2)}), i > 210 ? 0.0 : 1.0);
    scene.instrument(2, along_x({-0.002, 0.005 * std::sin(8 * t), 0.0005}), i > 50 ? 0.0 : 1.0);
    scene.step();
  }
}

ObjectDescription stage() {
  ObjectDescription d = block("liver", {0.05, 0.024, 0.016});
  d.vessels.push_back({.name = "artery", .radius_m = 0.002, .centre_line = {{-0.02, 0, -0.004}, {0.02, 0, -0.004}}});
  d.pools.push_back({.size_m = {0.1, 0.1}, .level_m = 0.002});
  return d;
}

void expect_equal(const TissueView& a, const TissueView& b) {
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  for (std::size_t i = 0; i < a.surfaces.size(); ++i) {
    EXPECT_EQ(a.surfaces[i].vertices, b.surfaces[i].vertices);
    EXPECT_EQ(a.surfaces[i].burn, b.surfaces[i].burn);
    EXPECT_EQ(a.surfaces[i].topology->triangles, b.surfaces[i].topology->triangles);
  }
  EXPECT_EQ(a.clips.size(), b.clips.size());
  ASSERT_EQ(a.particles.size(), b.particles.size());
  for (std::size_t i = 0; i < a.particles.size(); ++i) EXPECT_EQ(a.particles[i].at, b.particles[i].at);
  EXPECT_EQ(a.pool.level_m, b.pool.level_m);
  EXPECT_EQ(a.pool.blood, b.pool.blood);
  EXPECT_EQ(a.pool.heights_m, b.pool.heights_m);
  EXPECT_EQ(a.smoke, b.smoke);
  EXPECT_EQ(a.lens_fog, b.lens_fog);
}

TEST(WorldModel, equal_inputs_give_equal_results_and_a_reset_restores_all_to_the_bit) {
  Scene scene({stage()});
  const TissueView at_start = scene.view();
  play(scene);
  const TissueView played = scene.view();
  EXPECT_NE(played.surfaces[0].vertices, at_start.surfaces[0].vertices);
  {
    Scene other({stage()});
    play(other);
    expect_equal(other.view(), played);
  }
  scene.world().apply(ResetModel{});
  expect_equal(scene.view(), at_start);
  play(scene);
  expect_equal(scene.view(), played);
}

TEST(WorldModel, calculation_off_freezes) {
  Scene scene({block("liver", {0.04, 0.04, 0.016})});
  scene.instrument(0, downwards({0, 0, 0.001}));
  scene.move(0, {0, 0, -0.002}, 0.05);
  scene.world().apply(SetCalculation{false});
  EXPECT_FALSE(scene.state().calculating);
  const TissueView before = scene.view();
  scene.move(0, {0, 0, -0.006}, 0.05);
  EXPECT_EQ(scene.view().surfaces[0].vertices, before.surfaces[0].vertices);
  EXPECT_EQ(scene.response(0).contacts, 0U);
  scene.world().apply(SetCalculation{true});
  scene.steps(50);
  EXPECT_NE(scene.view().surfaces[0].vertices, before.surfaces[0].vertices);
  EXPECT_TRUE(finite(scene.view()));
}

// Presses 6 mm deep with a limit set; the state after it.
struct Pressed {
  TissueState state;
  double most = 0;
  int zero_steps = 0;  // with contacts before, but without effect
};

Pressed press(TissueLimit limit, std::uint8_t actions, double value) {
  Scene scene({block("liver", {0.04, 0.04, 0.02})});
  scene.world().apply(SetLimit{limit, actions, value});
  scene.instrument(0, downwards({0, 0, 0.002}));
  scene.step();
  Pressed out;
  for (int i = 0; i < 300; ++i) {
    scene.instrument(0, downwards({0, 0, 0.002 - 0.0001 * std::min(i, 80)}));
    scene.step();
    out.most = std::max(out.most, scene.response(0).force_W.norm());
    out.zero_steps += i > 40 && scene.response(0).contacts == 0 ? 1 : 0;
  }
  out.state = scene.state();
  return out;
}

TEST(WorldLimits, of_the_force_of_contacts) {
  const Pressed free = press(TissueLimit::contact_force, 0, 0);
  ASSERT_GT(free.most, 0.3);
  EXPECT_EQ(free.state.excesses[2], 0U);
  const Pressed counted = press(TissueLimit::contact_force, bit(TissueLimitAction::count), 0.1);
  EXPECT_GT(counted.state.excesses[2], 100U);
  EXPECT_EQ(counted.most, free.most) << "only counted";
  const Pressed clamped = press(TissueLimit::contact_force, bit(TissueLimitAction::clamp), 0.1);
  EXPECT_LE(clamped.most, 0.1 + 1e-9);
  const Pressed discarded = press(TissueLimit::contact_force, bit(TissueLimitAction::discard), 0.1);
  EXPECT_GT(discarded.zero_steps, 10);
  const Pressed frozen = press(TissueLimit::contact_force, bit(TissueLimitAction::freeze), 0.1);
  EXPECT_FALSE(has(frozen.state.objects[0].attributes, TissueAttribute::calculate));
  const Pressed reported = press(TissueLimit::contact_force, bit(TissueLimitAction::report), 0.1);
  EXPECT_EQ(reported.state.event_counts[9], 1U) << "once a second";
  EXPECT_EQ(reported.state.events.back().limit, TissueLimit::contact_force);
}

TEST(WorldLimits, of_strain_and_of_the_speed_of_nodes) {
  EXPECT_GT(press(TissueLimit::strain, bit(TissueLimitAction::count), 0.05).state.excesses[5], 10U);
  const Pressed slow = press(TissueLimit::node_speed, bit(TissueLimitAction::clamp), 0.02);
  EXPECT_GT(slow.state.excesses[4], 10U);
  const Pressed frozen = press(TissueLimit::strain, bit(TissueLimitAction::freeze), 0.05);
  EXPECT_FALSE(has(frozen.state.objects[0].attributes, TissueAttribute::calculate));
}

TEST(WorldLimits, of_an_instruments_speed) {
  for (const TissueLimitAction action : {TissueLimitAction::clamp, TissueLimitAction::discard}) {
    Scene scene({block("liver", {0.04, 0.04, 0.02})});
    scene.world().apply(SetLimit{TissueLimit::instrument_speed, bit(action), 0.05});
    scene.instrument(0, downwards({0, 0, 0.003}));
    scene.step();
    for (int i = 0; i < 40; ++i) {
      scene.instrument(0, downwards({0, 0, 0.003 - 0.0002 * i}));  // 0.2 m/s
      scene.step();
    }
    EXPECT_GT(scene.state().excesses[0], 20U);
    if (action == TissueLimitAction::discard) {
      EXPECT_EQ(scene.response(0).contacts, 0U);
    }
    // Clamped, it lags: after 40 steps it is 2 mm further.
    if (action == TissueLimitAction::clamp) {
      EXPECT_NEAR(scene.response(0).x_ref.z(), 0.001, 1e-4);
    }
  }
}

TEST(WorldLimits, of_penetration) {
  // An object that is not calculated keeps its shape: the instrument goes into it, and the limit counts it.
  ObjectDescription d = block("bone", {0.03, 0.03, 0.02});
  d.attributes &= static_cast<std::uint16_t>(~static_cast<unsigned>(TissueAttribute::calculate));
  Scene scene({d});
  scene.world().apply(SetLimit{TissueLimit::penetration, bit(TissueLimitAction::report), 0.001});
  scene.instrument(0, downwards({0, 0, 0.001}));
  scene.move(0, {0, 0, -0.002}, 0.02);
  EXPECT_GT(scene.state().excesses[1], 10U);
  EXPECT_EQ(scene.count(TissueEventKind::limit), 1);
  EXPECT_GT(scene.response(0).force_W.z(), 0.5) << "what cannot move is felt as stiff";
}

TEST(WorldLimits, release_lets_go_of_what_is_held) {
  Scene scene({block("liver", {0.04, 0.04, 0.02})});
  scene.world().apply(acts_below(0, InstrumentKind::gripper));
  scene.world().apply(SetLimit{TissueLimit::grip_force, bit(TissueLimitAction::release), 0.02});
  scene.instrument(0, downwards({0, 0, 0.0005}), 0.0);
  scene.step();
  ASSERT_GT(scene.response(0).held, 0U);
  scene.move(0, {0, 0, 0.02}, 0.02);
  EXPECT_EQ(scene.response(0).held, 0U);
  EXPECT_EQ(scene.count(TissueEventKind::slip), 0);
}

TEST(WorldModel, publishes_names_attributes_and_nodes) {
  Scene scene({stage()});
  scene.instrument(0, downwards({0, 0, -0.001}));
  scene.steps(20);
  TissueView view;
  scene.world().view(view, true);
  ASSERT_EQ(view.surfaces.size(), 1U);
  EXPECT_EQ(view.surfaces[0].name, "liver");
  EXPECT_TRUE(view.surfaces[0].wet);
  EXPECT_EQ(view.network.nodes.size(), scene.state().objects[0].nodes);
  EXPECT_EQ(view.network.kinds.size(), view.network.nodes.size());
  EXPECT_EQ(view.network.central_nodes.size(), 1U);
  scene.world().apply(SetAttributes{0, static_cast<std::uint16_t>(TissueAttribute::visible), 0});
  scene.world().view(view, false);
  EXPECT_FALSE(view.surfaces[0].visible);
  EXPECT_TRUE(view.network.nodes.empty());
  EXPECT_EQ(view.pool.columns * view.pool.columns, static_cast<int>(view.pool.heights_m.size()));
}

}  // namespace
}  // namespace cellmirror::tissue
