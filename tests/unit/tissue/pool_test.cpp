// Fluids: what goes in stays in, waves travel and calm down, drops fall.
#include "rt_core/tissue/effects/pool.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "rt_core/tissue/effects/particles.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

PoolDescription basin() {
  PoolDescription d;
  d.size_m = {0.1, 0.08};
  d.level_m = 0.01;
  return d;
}

TEST(Pool, volume_and_blood_add_up) {
  Pool pool(basin(), Pose::Identity());
  const double before = pool.level() * pool.area();
  pool.add(5e-6, 1.0);
  EXPECT_NEAR(pool.level() * pool.area(), before + 5e-6, 1e-12);
  EXPECT_NEAR(pool.blood() * pool.level() * pool.area(), 5e-6, 1e-12) << "all blood is still in it";
  const double share = pool.blood();
  pool.remove(10e-6);
  EXPECT_EQ(pool.blood(), share) << "what is drawn off is mixed";
  pool.add(50e-6, 0.0);
  EXPECT_LT(pool.blood(), share) << "water thins it";
  pool.remove(1.0);
  EXPECT_EQ(pool.level(), 0);
  pool.add(1.0, 0);
  EXPECT_EQ(pool.level(), basin().max_level_m) << "it overflows";
  pool.reset();
  EXPECT_EQ(pool.level(), 0.01);
  EXPECT_EQ(pool.blood(), 0);
}

TEST(Pool, colour_goes_from_its_own_to_blood) {
  Pool pool(basin(), Pose::Identity());
  TissuePool view;
  pool.view(view);
  EXPECT_EQ(view.rgba, basin().rgba);
  pool.add(50e-6, 1.0);
  TissuePool red;
  pool.view(red);
  EXPECT_LT(red.rgba[1], view.rgba[1]) << "less green";
  EXPECT_GT(red.rgba[3], view.rgba[3]) << "less transparent";
}

TEST(Pool, waves_keep_the_volume_travel_and_calm_down) {
  Pool pool(basin(), Pose::Identity());
  pool.disturb({-0.03, 0, 0.01}, -0.1, 0.006);
  TissuePool view;
  double largest = 0;
  bool arrived = false;
  for (int i = 0; i < 250; ++i) {  // a second
    pool.step(0.004);
    pool.view(view);
    const double sum = std::accumulate(view.heights_m.begin(), view.heights_m.end(), 0.0);
    ASSERT_NEAR(sum / static_cast<double>(view.heights_m.size()), 0, 1e-8);
    for (const float h : view.heights_m) largest = std::max(largest, static_cast<double>(std::abs(h)));
    // 60 mm away; at 0.25 m/s after a quarter of a second.
    const double there = std::abs(static_cast<double>(view.heights_m[16 * 32 + 25]));
    if (i == 25) {
      EXPECT_LT(there, 0.05 * largest) << "faster than waves are";
    }
    arrived = arrived || there > 0.02 * largest;
  }
  EXPECT_TRUE(arrived);
  EXPECT_GT(largest, 1e-5);
  EXPECT_LT(largest, 0.01);
  for (int i = 0; i < 5000; ++i) pool.step(0.004);
  EXPECT_TRUE(pool.at_rest());
}

TEST(Particles, drops_carry_their_volume_into_the_pool) {
  Pool pool(basin(), Pose::Identity());
  Particles particles;
  const double before = pool.level() * pool.area();
  double poured = 0;
  for (int i = 0; i < 3000; ++i) {
    if (i < 1000) {
      particles.pour(ParticleKind::blood, 1e-9, {0, 0, 0.05}, {0.1, 0, 0}, pool);
      poured += 1e-9;
    }
    particles.step(0.001, {0, 0, -9.81}, pool, false);
    ASSERT_LE(particles.count(), Particles::kMost);
  }
  EXPECT_EQ(particles.count(), 0U);
  EXPECT_NEAR(pool.level() * pool.area(), before + poured, 2e-8) << "but for a drop that is not whole";
}

TEST(Particles, are_bounded_and_equal_from_run_to_run) {
  const auto run = [] {
    Pool pool(basin(), Pose::Identity());
    Particles particles;
    for (int i = 0; i < 300; ++i) {
      particles.pour(ParticleKind::blood, 1e-6, {0, 0, 1.0}, {0.1, 0, 0}, pool);
      particles.smoke({0, 0, 0.1});
      particles.step(0.001, {0, 0, -9.81}, pool, true);
      EXPECT_LE(particles.count(), Particles::kMost);
    }
    std::vector<TissueParticle> view;
    particles.view(view);
    return view;
  };
  const auto a = run();
  const auto b = run();
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 100U);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].at, b[i].at);
}

}  // namespace
}  // namespace cellmirror::tissue
