// A hand in soft tissue, with a worker that is on time, late, stops, and lets go: what was put in is all that comes
// out, and the force makes no leaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "hand.hpp"
#include "tissue.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::HandParameters;
using test_rig::HandRun;
using test_rig::Rig;
using test_rig::StandInTissue;
using test_rig::stiffness_of_tissue;
using test_rig::TissueParameters;

// J: the allowance, what is forgiven of it in 2.5 s, and as much again for what the look ahead of two periods misses.
constexpr double kEnergyBound = 1.5e-3;

struct Worker {
  const char* name;
  int every;  // ms
  int delay;  // ms
};
constexpr Worker kOnTime[] = {{"1 ms", 1, 1}, {"3 ms", 1, 3}};
constexpr Worker kLate[] = {
    {"5 ms, at 200 Hz", 5, 5}, {"20 ms, at 50 Hz", 20, 20}, {"50 ms, at 1 kHz", 1, 50}, {"50 ms, at 20 Hz", 50, 50}};
constexpr double kModuli[] = {1e3, 5e3, 50e3};  // Pa

double smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// 10 mm into the tissue within a quarter of a second, at 1.0 s 40 mm up and aside, at 2.0 s back to the surface.
Vector3d press_and_lift(double t) {
  return {0.01 * smooth((t - 1.0) / 0.25), 0,
          0.01 - 0.02 * smooth((t - 0.4) / 0.25) + 0.04 * smooth((t - 1.0) / 0.3) - 0.03 * smooth((t - 2.0) / 0.3)};
}

TissueParameters tissue_of(double modulus, const Worker& worker) {
  TissueParameters made;
  made.stiffness = stiffness_of_tissue(modulus);
  made.damping = 2e-3 * made.stiffness;
  made.every = worker.every;
  made.delay = worker.delay;
  return made;
}

HandRun run(const HapticSettings& settings, const TissueParameters& tissue, const HandParameters& hand) {
  Rig rig(gantry(settings));
  rig.tissue_worker = StandInTissue(tissue);
  return run_hand(rig, hand, 2500, press_and_lift);
}

void expect_passive(const TissueParameters& tissue, const std::string& what) {
  const HapticSettings settings;
  for (const double mass : {0.05, 0.2, 0.5}) {
    for (const double damping : {0.5, 5.0}) {
      const HandRun sut = run(settings, tissue, {.mass = mass, .damping = damping});
      const std::string where =
          what + ", " + std::to_string(tissue.stiffness) + " N/m, hand of " + std::to_string(mass) + " kg";
      EXPECT_GT(sut.least_energy, -kEnergyBound) << where;
      EXPECT_FALSE(sut.faulted) << where;
      EXPECT_LE(sut.largest_force, settings.max_force + 1e-9) << where;
      EXPECT_LE(sut.largest_step, settings.max_slew * 1e-3 + 1e-9) << where;
      EXPECT_GT(sut.largest_force, 0.02) << where << ": felt nothing, so it proves nothing";
    }
  }
}

TEST(TissueEnergy, OfTissueThatIsPressedAndLeft) {
  for (const double modulus : kModuli) {
    for (const Worker& worker : kOnTime) expect_passive(tissue_of(modulus, worker), worker.name);
    for (const Worker& worker : kLate) expect_passive(tissue_of(modulus, worker), worker.name);
  }
}

TEST(TissueEnergy, OfAWorkerThatStopsWhileTheHandPresses) {
  for (const double modulus : kModuli) {
    for (const Worker& worker : {kOnTime[1], kLate[1]}) {
      TissueParameters tissue = tissue_of(modulus, worker);
      tissue.stops_at = 1.0;
      expect_passive(tissue, worker.name);
    }
  }
}

TEST(TissueEnergy, OfTissueThatIsGrippedLiftedAndReleasedUnderLoad) {
  for (const double modulus : kModuli) {
    for (const Worker& worker : {kOnTime[0], kOnTime[1], kLate[1], kLate[2]}) {
      TissueParameters tissue = tissue_of(modulus, worker);
      tissue.grips_at = 0.7;
      tissue.releases_at = 1.6;
      expect_passive(tissue, worker.name);
    }
  }
}

TEST(TissueEnergy, OfGrippedTissueThatIsCutOffUnderLoad) {
  for (const double modulus : kModuli) {
    for (const Worker& worker : {kOnTime[0], kOnTime[1], kLate[1], kLate[3]}) {
      TissueParameters tissue = tissue_of(modulus, worker);
      tissue.grips_at = 0.7;
      tissue.removed_at = 1.6;
      expect_passive(tissue, worker.name);
    }
  }
}

TEST(TissueEnergy, WouldBeGeneratedByALateWorkerWithoutTheController) {
  HapticSettings settings;
  settings.passivity_control = false;
  TissueParameters tissue = tissue_of(50e3, kLate[1]);
  tissue.local_stiffness = false;
  EXPECT_LT(run(settings, tissue, {.mass = 0.2, .damping = 0.5}).least_energy, -20 * kEnergyBound)
      << "else the tests above prove nothing";
}

TEST(TissueEnergy, LocalStiffnessBridgesTheDelay) {
  HapticSettings settings;
  settings.passivity_control = false;
  TissueParameters tissue = tissue_of(50e3, kOnTime[1]);
  tissue.damping = 0;
  const HandParameters hand{.mass = 0.1, .damping = 2.0};
  EXPECT_GT(run(settings, tissue, hand).least_energy, -kEnergyBound);
  tissue.local_stiffness = false;
  EXPECT_LT(run(settings, tissue, hand).least_energy, -3 * kEnergyBound);
}

TEST(TissueEnergy, SmoothedForcesNeedPlacesThatAreSmoothedToo) {
  HapticSettings settings;
  settings.passivity_control = false;
  TissueParameters tissue = tissue_of(50e3, kOnTime[0]);
  tissue.smoothing = 0.2;
  const HandParameters hand{.mass = 0.1, .damping = 0.5};
  EXPECT_GT(run(settings, tissue, hand).least_energy, -kEnergyBound);
  tissue.smooths_place = false;
  EXPECT_LT(run(settings, tissue, hand).least_energy, -10 * kEnergyBound);
}

// Tissue that becomes stiffer the deeper it is pressed has stored more than a spring of its local stiffness; what a
// hand has put in comes back in full.
TEST(TissueEnergy, ComesBackUncutFromElasticTissueThatStiffens) {
  for (const double power : {1.0, 1.5, 3.0}) {
    HapticSettings settings = test_rig::plain_settings();
    settings.passivity_control = true;
    Rig rig(gantry(settings));
    const auto force_at = [power](double z) { return z < 0 ? 2.0 * std::pow(-z / 0.01, power) : 0.0; };
    rig.show_tissue = true;
    rig.tissue_worker = [&](Rig& r) {
      const double z = r.state().x_proxy.z();
      ++r.tissue.sequence;
      r.tissue.slot = r.instrument.slot;
      r.tissue.posture_time = r.now;
      r.tissue.x_ref = r.state().x_proxy;
      r.tissue.contacts = z < 0 ? 1 : 0;
      r.tissue.force_W = {0, 0, force_at(z)};
      r.tissue.stiffness.setZero();
      r.tissue.stiffness(2, 2) = z < 0 ? power * force_at(z) / -z : 0.0;
    };
    rig.go({0, 0, 0.002}, 200);
    for (int times = 0; times < 5; ++times) {
      for (int i = 0; i <= 800; ++i) {
        const double z = -0.005 + 0.005 * std::cos(i * 2 * 3.14159265358979 / 800);
        rig.tick({0, 0, z});
        EXPECT_EQ(rig.state().passivity_damping, 0.0) << power;
        EXPECT_NEAR(rig.port.output.force_D.z(), force_at(z), 0.02) << power << " at " << z;
      }
    }
  }
}

// What friction takes in is no credit: after a long stroke over tissue it cannot push for long.
TEST(TissueEnergy, OfFrictionDoesNotComeBack) {
  HapticSettings settings = test_rig::plain_settings();
  settings.passivity_control = true;
  Rig rig(gantry(settings));
  rig.show_tissue = true;
  double along = -0.3;  // N, against the stroke
  rig.tissue_worker = [&](Rig& r) {
    ++r.tissue.sequence;
    r.tissue.slot = r.instrument.slot;
    r.tissue.posture_time = r.now;
    r.tissue.x_ref = r.state().x_proxy;
    r.tissue.contacts = 1;
    r.tissue.force_W = {along, 0, 0.5};
    r.tissue.stiffness.setZero();
    r.tissue.stiffness(2, 2) = 100;
  };
  rig.go({-0.2, 0, 0}, 200);
  rig.go({0.2, 0, 0}, 0);
  EXPECT_LT(rig.state().energy, 0.09) << "0.12 J went in; a spring of 5 N/m has not stored more";
  along = 0.3;  // pushes with the hand now: tissue never does
  rig.go({0.45, 0, 0}, 0);
  EXPECT_LT(rig.port.output.force_D.norm(), 0.3) << "cut";
  EXPECT_GT(rig.state().energy, -2.5e-3);
}

}  // namespace
}  // namespace cellmirror::haptics
