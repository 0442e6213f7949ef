// Random instruments and commands for some seconds of simulated time: whatever comes, numbers stay finite and lists
// bounded.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rt_core/geometry/solid.hpp"
#include "tests/unit/tissue/world_scene.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

class RandomHands {
 public:
  explicit RandomHands(std::uint32_t seed) : generator_(seed) {}

  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  Command command() {
    switch (whole(0, 9)) {
      case 0:
        return acts_below(whole(0, 2), static_cast<InstrumentKind>(whole(0, 4)));
      case 1:
        return SetLimit{static_cast<TissueLimit>(whole(0, 5)), static_cast<std::uint8_t>(whole(0, 63) & ~16),
                        number(0, 3)};
      case 2:
        return SetEffect{static_cast<TissueEffect>(whole(0, 4)), whole(0, 1) == 1, whole(-1, 3)};
      case 3:
        return SetInstrumentShape{whole(0, 2), {number(-1, 0.01), number(0, 0.01), number(0, 0.05), number(0, 0.4)}};
      case 4:
        return SetAttributes{whole(-1, 2), static_cast<std::uint16_t>(whole(0, 4095)), kAllTissueAttributes};
      case 5:
        return SetCalculation{whole(0, 3) > 0};
      case 6:
        return whole(0, 20) == 0 ? Command(ResetModel{}) : Command(CleanLens{});
      case 7:
        return ResetPool{};
      case 8:
        return SetConnections{{{.name = "band",
                                .object_a = "liver",
                                .object_b = whole(0, 1) == 1 ? "lump" : "nothing",
                                .point_a = {0, 0, 0},
                                .point_b = {0, 0, 0},
                                .radius_m = number(0, 0.02),
                                .stiffness_n_m = number(-10, 1e5),
                                .tear_force_n = number(-1, 2)}}};
      default:
        return SetClip{whole(0, 2), {.name = "clip", .length_m = number(0, 0.02), .shape = {}}};
    }
  }

 private:
  std::mt19937 generator_;
};

TEST(WorldRandom, stays_finite_and_bounded) {
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    ObjectDescription liver = block("liver", {0.05, 0.03, 0.016});
    liver.vessels.push_back(
        {.name = "artery", .radius_m = 0.002, .centre_line = {{-0.02, 0, -0.004}, {0.02, 0, -0.004}}});
    liver.vessels.push_back(
        {.name = "vein", .kind = VesselKind::vein, .centre_line = {{0, -0.01, -0.004}, {0, 0.01, -0.004}}});
    liver.pools.push_back({.size_m = {0.1, 0.1}, .level_m = 0.002});
    liver.material.tear_strain = 1.5;
    ObjectDescription lump = block("lump", {0.02, 0.02, 0.016}, false);
    lump.X_WO.translation() = Vector3d(0.005, 0, 0.017);
    lump.material.tear_strain = 1.0;
    Scene scene({liver, lump});
    RandomHands hands(seed);
    const geometry::Solid ball = geometry::make_primitive(Shape::sphere, Vector3d::Constant(0.02));
    std::array<Vector3d, 3> at{Vector3d(0, 0, 0.03), Vector3d(0.01, 0, 0.03), Vector3d(-0.01, 0, 0.03)};
    std::array<Vector3d, 3> speed{};
    for (int i = 0; i < 1500; ++i) {
      if (i % 25 == 0) scene.world().apply(hands.command());
      for (std::size_t tool = 0; tool < 3; ++tool) {
        if (i % 50 == 0) {
          const Vector3d goal(hands.number(-0.03, 0.03), hands.number(-0.02, 0.02), hands.number(-0.012, 0.02));
          speed[tool] = (goal - at[tool]) / 0.05;
        }
        at[tool] += kStep_s * speed[tool];
        if (hands.whole(0, 400) == 0) at[tool] = Vector3d(hands.number(-0.03, 0.03), 0, hands.number(-0.02, 0.02));
        const Vector3d p = hands.whole(0, 300) == 0 ? Vector3d(std::nan(""), 0, 0) : at[tool];
        const double q = (i / 150 + static_cast<int>(tool)) % 2 == 0 ? 0.0 : 1.0;
        scene.instrument(static_cast<int>(tool), tool == 1 ? along_x(p) : downwards(p), q);
      }
      Pose X_WB = Pose::Identity();
      X_WB.translation() = Vector3d(0.03 * std::sin(0.003 * i), 0.02, 0.015);
      scene.set_bodies({{.id = 1, .solid = &ball, .X_WB = X_WB}});
      scene.step();
      for (int slot = 0; slot < 3; ++slot) {
        const InstrumentResponse felt = scene.response(slot);
        ASSERT_TRUE(felt.force_W.allFinite() && felt.torque_W.allFinite() && felt.stiffness.allFinite());
        ASSERT_LE(felt.held, 12U);
      }
      if (i % 20 != 0) continue;
      const TissueView view = scene.view();
      for (const TissueSurface& surface : view.surfaces) {
        for (const Eigen::Vector3f& vertex : surface.vertices)
          ASSERT_TRUE(vertex.allFinite()) << "seed " << seed << " step " << i;
      }
      ASSERT_LE(view.particles.size(), 512U);
      ASSERT_LE(view.clips.size(), 64U);
      ASSERT_TRUE(std::isfinite(view.pool.level_m) && std::isfinite(view.smoke));
      ASSERT_LE(scene.state().events.size(), 64U);
    }
  }
}

}  // namespace
}  // namespace cellmirror::tissue
