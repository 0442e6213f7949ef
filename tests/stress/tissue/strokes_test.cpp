// Random strokes of a blade over several bodies, which swing, burn and yield meanwhile: positions stay finite, the
// volume and the closed surface are kept, memory is bounded, and what is left is stable.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

constexpr std::size_t kUsualStrokes = 15'000;
constexpr std::size_t kStrokesOfABody = 400;  // until hardly a link is left; then it is made whole again

std::size_t wanted_strokes() {
  const char* const wanted = std::getenv("CELLMIRROR_TISSUE_STROKES");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : kUsualStrokes;
}

struct Subject {
  Body body;
  double volume = 0;
  double size = 0;
  double step = 0;
  std::size_t strokes = 0;
  std::size_t most_nodes = 0;
};

std::vector<Subject> subjects() {
  std::vector<ObjectDescription> descriptions;
  descriptions.push_back(ball(0.03, 0.014));
  ObjectDescription bent = ball(0.04, 0.015);  // thin and not convex
  for (Eigen::Vector3d& p : bent.surface.vertices) p.z() = 0.4 * p.z() + 8.0 * p.x() * p.x();
  descriptions.push_back(bent);
  ObjectDescription hard = block(Eigen::Vector3d(0.03, 0.03, 0.03), {4, 4, 4});
  hard.material.youngs_modulus_pa = 2e5;
  hard.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(1, 1, 0.001)});
  descriptions.push_back(hard);
  ObjectDescription plastic = ball(0.03, 0.015);
  plastic.material.yield_strain = 0.1;
  plastic.attributes |= static_cast<std::uint16_t>(TissueAttribute::plastic);
  plastic.regions.push_back({.name = "vessel", .a = {-0.1, 0, 0}, .b = {0.1, 0, 0}, .radius_m = 0.006, .material = {}});
  plastic.regions[0].material.youngs_modulus_pa = 1e5;
  descriptions.push_back(plastic);
  std::vector<Subject> made_of_them;
  for (const ObjectDescription& d : descriptions) {
    Body body = made(d);
    const double volume = body.volume_at_rest();
    const double step = step_of(body);
    made_of_them.push_back({.body = std::move(body), .volume = volume, .size = 0.03, .step = step});
  }
  return made_of_them;
}

void expect_sound(Subject& s) {
  const TissueObjectState state = state_of(s.body);
  ASSERT_NEAR(state.volume_m3, s.volume, 1e-6 * s.volume);
  ASSERT_LE(state.elements, 4 * state.elements_at_start);
  ASSERT_LE(s.body.positions().size(), 16 * state.elements_at_start);
  // Of an element's surface: at most 4 faces of 4 triangles and 6 edges of 4, each with 3 points.
  ASSERT_LE(s.body.surface_points().size(), 120 * state.elements_at_start);
  for (const Eigen::Vector3d& p : s.body.positions()) ASSERT_TRUE(p.allFinite());
  // Faster than the waves of this tissue by far: nothing flies apart.
  for (const Eigen::Vector3d& v : s.body.velocities()) ASSERT_LT(v.norm(), 5.0);
  const SurfaceSums sums = surface_sums(s.body);
  ASSERT_LT(sums.area.norm(), 1e-6 * sums.size);
  s.most_nodes = std::max(s.most_nodes, s.body.positions().size());
}

TEST(TissueStress, RandomStrokesKeepVolumeSurfaceAndSense) {
  std::vector<Subject> all = subjects();
  std::mt19937 random(20'261'123);
  std::uniform_int_distribution<std::size_t> which(0, all.size() - 1);
  std::uniform_int_distribution<int> percent(0, 99);
  std::normal_distribution<double> normal;
  const std::size_t wanted = wanted_strokes();
  std::size_t links = 0;
  std::size_t rounds = 0;
  for (std::size_t i = 0; i < wanted; ++i) {
    Subject& s = all[which(random)];
    BladeSweep sweep = random_sweep(random, s.size);
    const int kind = percent(random);
    if (kind < 50) {  // a short cut as scissors make it
      sweep.along *= 0.3;
      sweep.across *= 0.1;
    }
    if (kind == 99) s.body.heat(sweep.corner, sweep.corner + sweep.along, 0.01, 0.2);
    links += s.body.cut(sweep).links;
    if (kind % 10 == 0) {
      s.body.begin_step(s.step, Eigen::Vector3d(0, 0, -9.81));
      for (std::uint32_t n = 0; n < s.body.positions().size(); n += 17) {
        s.body.add_velocity(n, 0.02 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
      }
      s.body.end_step(s.step);
    }
    if (kind == 50) expect_sound(s);
    if (testing::Test::HasFatalFailure()) FAIL() << "stroke " << i;
    if (++s.strokes < kStrokesOfABody) continue;
    // What is left comes to rest by itself.
    double energy = step_energy(s.body, s.step);
    for (int k = 0; k < 50; ++k) {
      const double next = step_energy(s.body, s.step);
      ASSERT_LE(next, 1.05 * energy + 1e-9) << "stroke " << i;
      energy = std::min(energy, next);
    }
    expect_sound(s);
    s.body.reset();
    s.strokes = 0;
    ++rounds;
  }
  EXPECT_GT(links, wanted / 2);  // many of them divide
  for (const Subject& s : all) EXPECT_GT(s.most_nodes, 0U);
  fmt::print("{} strokes divided {} links; bodies were made whole again {} times\n", wanted, links, rounds);
}

}  // namespace
}  // namespace cellmirror::tissue
