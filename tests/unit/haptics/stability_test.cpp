// A hand at a stiff wall: what was put in is all that comes out.
#include <gtest/gtest.h>

#include "hand.hpp"

namespace cellmirror::haptics {
namespace {

using test_rig::HandParameters;
using test_rig::HandRun;
using test_rig::press_wall;

// The bound that docs/performance.md states: three allowances in a press of three seconds.
constexpr double kBound = 3e-3;  // J

HapticSettings wall_of(double stiffness) {
  HapticSettings settings;
  settings.stiffness = stiffness;
  return settings;
}

TEST(VirtualWall, GivesNoEnergyUpTo3000NewtonPerMetreToAnyHand) {
  for (const double stiffness : {1000.0, 2000.0, 3000.0}) {
    for (const double mass : {0.05, 0.1, 0.2, 0.5}) {
      for (const double damping : {0.5, 2.0, 5.0}) {
        const HandRun run = press_wall(wall_of(stiffness), {.mass = mass, .damping = damping}, 0.01, 3.0);
        EXPECT_GT(run.least_energy, -kBound) << stiffness << " N/m, " << mass << " kg, " << damping << " Ns/m";
        EXPECT_FALSE(run.faulted);
        EXPECT_LE(run.largest_force, 8.0 + 1e-9);
      }
    }
  }
}

TEST(VirtualWall, IsAsStiffAsStatedAndQuietUnderAnOrdinaryHand) {
  for (const double stiffness : {500.0, 1000.0, 3000.0}) {
    HapticSettings settings = wall_of(stiffness);
    const HandParameters hand{.mass = 0.15, .damping = 8.0};
    const HandRun run = press_wall(settings, hand, 0.01, 3.0);
    EXPECT_LT(run.peak_to_peak, 3 * hand.encoder_step) << stiffness;
    EXPECT_NEAR(run.force_at_end, stiffness * run.depth_at_end, 2 * stiffness * hand.encoder_step);
  }
}

TEST(VirtualWall, WouldShakeALightlyDampedHandWithoutTheController) {
  HapticSettings settings = wall_of(3000);
  settings.passivity_control = false;
  const HandRun run = press_wall(settings, {.mass = 0.15, .damping = 2.0}, 0.01, 3.0);
  EXPECT_LT(run.least_energy, -50 * kBound) << "else the tests above prove nothing";
}

TEST(Passivity, EndsWhatGeneratesMoreThanCutsCanTake) {
  HapticSettings settings = wall_of(3000);
  settings.max_passivity_damping = 1;
  settings.energy_allowance = 1e-4;
  EXPECT_TRUE(press_wall(settings, {.mass = 0.15, .damping = 2.0}, 0.01, 3.0).faulted);
}

}  // namespace
}  // namespace cellmirror::haptics
