// What the hand feels of soft tissue, in closed form: through the whole channel.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rig.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tissue.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::model_of;
using test_rig::plain_settings;
using test_rig::plane;
using test_rig::Rig;
using test_rig::trocar;

constexpr int kFadedIn = 110;  // ticks

// A gantry in free space, with a worker that says the same of the tissue in every tick until it is told otherwise.
struct TissueRig : Rig {
  explicit TissueRig(const HapticSettings& settings = plain_settings()) : TissueRig(gantry(settings)) {}
  explicit TissueRig(const Instrument& made) : Rig(made) {
    model = model_of({}, Vector3d::Zero());
    tissue.slot = instrument.slot;
    tissue.contacts = 1;
    show_tissue = true;
    tissue_worker = [this](Rig&) {
      if (!working) return;
      ++tissue.sequence;
      tissue.posture_time = now;
    };
  }

  [[nodiscard]] Vector3d force() const { return port.output.force_D; }

  bool working = true;
};

Matrix3d plane_stiffness(const Vector3d& normal, double stiffness) { return stiffness * normal * normal.transpose(); }

TEST(Tissue, IsFeltAsTheLinearForceAboutTheReference) {
  TissueRig rig;
  rig.tissue.x_ref = {0.001, 0, 0};
  rig.tissue.force_W = {0, 0.2, 1.0};
  rig.tissue.stiffness << 100, 20, 0, 20, 200, 0, 0, 0, 300;
  rig.go({0, 0, 0}, kFadedIn);
  for (const Vector3d& x : {Vector3d(0.001, 0, 0), Vector3d(0.002, -0.002, -0.0005), Vector3d(0, -0.0005, -0.002),
                            Vector3d(0.001, -0.001, -0.003)}) {
    rig.go(x);
    const Vector3d expected = rig.tissue.force_W - rig.tissue.stiffness * (x - rig.tissue.x_ref);
    EXPECT_NEAR((rig.force() - expected).norm(), 0, 1e-9) << x.transpose();
    EXPECT_NEAR((rig.state().tissue_force_W - expected).norm(), 0, 1e-9);
  }
  EXPECT_NEAR((rig.force() - Vector3d(0.02, 0.4, 1.9)).norm(), 0, 1e-9);
  EXPECT_EQ(rig.state().tissue_contacts, 1U);
  EXPECT_EQ(rig.state().contacts, 0) << "those are of rigid bodies";
  EXPECT_NEAR((rig.state().x_proxy - Vector3d(0.001, -0.001, -0.003)).norm(), 0, 1e-9) << "the tip enters";
}

TEST(Tissue, DoesNotPullATipThatItDoesNotHold) {
  TissueRig rig;
  rig.tissue.force_W = {0, 0, 1};
  rig.tissue.stiffness = 500 * Matrix3d::Identity();
  rig.go({0, 0, 0}, kFadedIn);
  rig.go({0.001, 0, 0.001});
  EXPECT_NEAR(rig.force().z(), 0.5, 1e-9);
  EXPECT_NEAR(rig.force().x(), -0.25, 1e-9) << "half of the pressure is gone, and half of what it holds across";
  rig.go({0.001, 0, 0.003});
  EXPECT_NEAR(rig.force().norm(), 0, 1e-12);
  rig.tissue.held = 1;
  rig.go({0.001, 0, 0.003});
  EXPECT_NEAR((rig.force() - Vector3d(-0.5, 0, -0.5)).norm(), 0, 1e-9) << "what jaws hold pulls";
}

TEST(Tissue, WithoutAForceAtTheReferencePushesNowhere) {
  TissueRig rig;
  rig.tissue.stiffness = 500 * Matrix3d::Identity();
  rig.go({0, 0, -0.001}, kFadedIn);
  EXPECT_TRUE(rig.force().isZero(0)) << "where to is not known";
  rig.tissue.held = 1;
  rig.go({0, 0, -0.001});
  EXPECT_NEAR(rig.force().z(), 0.5, 1e-9) << "what is held has a place";
}

TEST(Tissue, AwayFromTheReferenceTheForceStaysAndThenVanishes) {
  TissueRig rig;
  rig.tissue.force_W = {0, 0, 1};
  rig.tissue.stiffness = plane_stiffness(Vector3d::UnitZ(), 100);
  rig.go({0, 0, 0}, kFadedIn);
  rig.go({0, 0, -0.004});
  EXPECT_NEAR(rig.force().z(), 1.4, 1e-9);
  rig.go({0, 0, -0.009});
  EXPECT_NEAR(rig.force().z(), 1.5, 1e-9) << "as 5 mm away";
  rig.go({0, 0, -0.015});
  EXPECT_NEAR(rig.force().z(), 0.75, 1e-9) << "half way from 10 to 20 mm";
  rig.go({0, 0, -0.021});
  EXPECT_TRUE(rig.force().isZero(0));
}

TEST(Tissue, IsNeverFeltStifferThanTheCouplingAndNeverBeyondTheLargestForce) {
  HapticSettings settings = plain_settings();
  settings.stiffness = 400;
  settings.max_force = 3;
  TissueRig rig(settings);
  rig.tissue.force_W = {0, 0, 10};
  rig.tissue.stiffness = plane_stiffness(Vector3d::UnitZ(), 4000);
  rig.go({0, 0, 0.002}, kFadedIn);
  EXPECT_NEAR(rig.force().z(), 0.2, 1e-9) << "a tenth of 2 N";
  rig.go({0, 0, 0}, 5);
  EXPECT_NEAR(rig.force().z(), 1.0, 1e-9);
  rig.go({0, 0, -0.009}, 5);
  EXPECT_NEAR(rig.force().z(), 3.0, 1e-9);
}

TEST(Tissue, ThatStopsToBeComputedFadesOutSmoothlyWithoutAFault) {
  TissueRig rig;
  rig.tissue.force_W = {0, 0, 1};
  rig.go({0, 0, 0}, kFadedIn);
  ASSERT_NEAR(rig.force().z(), 1, 1e-9);
  EXPECT_EQ(rig.state().tissue_late, 0U);
  rig.working = false;
  const Timestamp last_time = rig.state().tissue_time;
  double before = 1;
  for (int i = 0; i < 250; ++i) {
    rig.tick(Vector3d::Zero());
    EXPECT_LE(std::abs(rig.force().z() - before), 0.0101) << i;
    before = rig.force().z();
    if (i == 95) {
      EXPECT_NEAR(before, 1, 1e-9) << "a tenth of a second old";
    }
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(rig.state().phase, HapticPhase::active);
  EXPECT_EQ(rig.state().tissue_time, last_time);
  EXPECT_EQ(rig.state().tissue_late, 1U) << "one response, counted once";
  rig.working = true;
  for (int i = 0; i < kFadedIn; ++i) {
    rig.tick(Vector3d::Zero());
    EXPECT_LE(std::abs(rig.force().z() - before), 0.015) << i;
    before = rig.force().z();
  }
  EXPECT_NEAR(before, 1, 1e-9);
}

TEST(Tissue, OfALateWorkerIsSoftenedWhereItIsStiffAndOnlyThere) {
  for (const double stiffness : {40.0, 800.0}) {
    TissueRig rig;  // its coupling: 1000 N/m
    test_rig::TissueParameters late{.stiffness = stiffness, .damping = 0, .delay = 20};
    rig.tissue_worker = test_rig::StandInTissue(late);
    rig.go({0, 0, 0.001}, 2 * kFadedIn);
    rig.go({0, 0, -0.002}, 200);
    // 5 ms late are borne at the full 1000 N/m, the twentieth millisecond at 250.
    const double felt = stiffness < 250 ? stiffness : 250.0;
    EXPECT_NEAR(rig.force().z() / 0.002, felt, 0.05 * felt) << stiffness;
    EXPECT_GT(rig.state().tissue_late, 100U);
  }
}

TEST(Tissue, StepsOfASlowWorkerAreSmoothed) {
  TissueRig rig;
  rig.tissue_worker = [&rig, ticks = 0](Rig&) mutable {
    if (++ticks % 20 != 0) return;
    ++rig.tissue.sequence;
    rig.tissue.posture_time = rig.now;
    rig.tissue.force_W = {0, 0, rig.tissue.sequence % 2 == 0 ? 1.0 : 1.4};
  };
  rig.go({0, 0, 0}, 300);
  double before = rig.force().z();
  double low = before;
  double high = before;
  for (int i = 0; i < 200; ++i) {
    rig.tick(Vector3d::Zero());
    EXPECT_LT(std::abs(rig.force().z() - before), 0.05) << "0.4 N in one tick without it";
    before = rig.force().z();
    low = std::min(low, before);
    high = std::max(high, before);
  }
  EXPECT_GT(high - low, 0.3) << "and arrives";
}

TEST(Tissue, WhatComesAfterAPauseArrivesSmoothly) {
  TissueRig rig;
  rig.tissue.force_W = {0, 0, 1};
  rig.go({0, 0, 0}, kFadedIn);
  rig.working = false;
  rig.go({0, 0, 0}, 50);
  ASSERT_NEAR(rig.force().z(), 1, 1e-9);
  rig.working = true;
  rig.tissue.force_W = {0, 0, 2};
  double before = 1;
  for (int i = 0; i < 60; ++i) {
    rig.tick(Vector3d::Zero());
    EXPECT_LT(std::abs(rig.force().z() - before), 0.15) << i;
    before = rig.force().z();
  }
  EXPECT_NEAR(before, 2, 1e-6);
}

TEST(Tissue, AddsToTheForceOfAWallAtWhichTheTipStands) {
  TissueRig rig;
  rig.model = model_of({plane(Vector3d::UnitZ(), -0.002, Vector3d::Zero())}, Vector3d::Zero());
  rig.tissue.stiffness = plane_stiffness(Vector3d::UnitZ(), 100);
  rig.tissue.force_W = {0, 0, 0.1};
  rig.go({0, 0, 0}, kFadedIn);
  rig.go({0, 0, -0.005});
  EXPECT_NEAR(rig.force().z(), 1000 * 0.003 + 0.1 + 100 * 0.002, 1e-6) << "of the tip at -2 mm";
  EXPECT_NEAR(rig.state().tissue_force_W.z(), 0.3, 1e-6);
  EXPECT_EQ(rig.state().contacts, 1);
}

TEST(Tissue, FadesInWithTheEngagementAndIsNotFeltWhileClutchedOrFaulted) {
  HapticSettings settings = plain_settings();
  settings.engage_time = Nanoseconds{400'000'000};
  settings.clutch_button = 0;
  settings.max_slew = 100;
  TissueRig rig(settings);
  rig.tissue.force_W = {0, 0, 1};
  rig.go({0, 0, 0}, 200);
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  EXPECT_NEAR(rig.force().z(), 0.5, 0.01);
  rig.go({0, 0, 0}, 300);
  EXPECT_NEAR(rig.force().z(), 1, 1e-9);
  rig.port.sample.buttons = 1;
  rig.tick(Vector3d::Zero());
  EXPECT_EQ(rig.state().phase, HapticPhase::clutched);
  EXPECT_NEAR(rig.force().z(), 0.9, 1e-9) << "at max_slew";
  EXPECT_TRUE(rig.state().tissue_force_W.isZero(0));
  rig.go({0, 0, 0}, 20);
  EXPECT_TRUE(rig.force().isZero(0));
  rig.port.sample.buttons = 0;
  rig.tick(Vector3d::Zero());
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  EXPECT_LT(rig.force().z(), 0.01);
  rig.go({0, 0, 0}, 500);
  EXPECT_NEAR(rig.force().z(), 1, 1e-9);
  rig.tick(Vector3d(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_EQ(rig.state().phase, HapticPhase::faulted);
  EXPECT_TRUE(rig.force().isZero(0));
  EXPECT_TRUE(rig.state().tissue_force_W.isZero(0));
}

TEST(Tissue, ForceChangesByNoMoreThanMaxSlew) {
  HapticSettings settings = plain_settings();
  settings.max_slew = 1000;
  TissueRig rig(settings);
  rig.go({0, 0, 0}, kFadedIn);
  rig.tissue.force_W = {0, 0, 3};
  for (int i = 1; i <= 5; ++i) {
    rig.tick(Vector3d::Zero());
    EXPECT_NEAR(rig.force().z(), std::min(3.0, i * 1.0), 1e-9);
  }
  rig.tissue.force_W.setZero();  // cut off
  rig.tick(Vector3d::Zero());
  EXPECT_NEAR(rig.force().z(), 2, 1e-9);
}

TEST(Tissue, OfAnotherInstrumentDoesNotCount) {
  TissueRig rig;
  rig.tissue.force_W = {0, 0, 1};
  ++rig.tissue.slot;
  rig.go({0, 0, 0}, kFadedIn);
  EXPECT_TRUE(rig.force().isZero(0));
  EXPECT_FALSE(rig.state().tissue_time.known());
  EXPECT_EQ(rig.state().tissue_refused, 0U);
  --rig.tissue.slot;
  rig.go({0, 0, 0}, kFadedIn);
  EXPECT_NEAR(rig.force().z(), 1, 1e-9);
  rig.sut.exchange(rig.instrument);
  rig.working = false;
  rig.show_tissue = false;
  rig.go({0, 0, 0}, kFadedIn);
  EXPECT_TRUE(rig.force().isZero(0)) << "what is known is of the instrument before";
}

struct HostileTissue : testing::Test {
  HostileTissue() {
    rig.tissue.force_W = {0, 0, 1};
    rig.go({0, 0, 0}, kFadedIn);
    good = rig.tissue;
  }
  // The hostile response in five ticks: refused five times, and the good one still counts.
  void expect_refused(const char* what) {
    const std::uint64_t before = rig.state().tissue_refused;
    for (int i = 0; i < 5; ++i) {
      rig.tick(Vector3d::Zero());
      EXPECT_NEAR(rig.force().z(), 1, 1e-9) << what;
    }
    EXPECT_EQ(rig.state().tissue_refused, before + 5) << what;
    const std::uint64_t sequence = rig.tissue.sequence;
    rig.tissue = good;
    rig.tissue.sequence = sequence;
    rig.tick(Vector3d::Zero());
    EXPECT_EQ(rig.state().tissue_refused, before + 5) << what;
  }

  TissueRig rig;
  TissueForce good;
};

TEST_F(HostileTissue, IsRefusedAndCountedAndTheLastGoodOneStays) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double value : {kNan, kInfinite, -kInfinite, 1e300}) {
    rig.tissue.x_ref.x() = value;
    expect_refused("place");
    rig.tissue.force_W.y() = value;
    expect_refused("force");
    rig.tissue.torque_W.z() = value;
    expect_refused("torque");
    rig.tissue.stiffness(1, 1) = value;
    expect_refused("stiffness");
  }
  rig.tissue.stiffness(0, 1) = 10;
  expect_refused("not symmetric");
  rig.tissue.stiffness(2, 2) = -10;
  expect_refused("negative");
  rig.tissue.stiffness << 1, 2, 0, 2, 1, 0, 0, 0, 1;
  expect_refused("negative in a direction between axes");
  rig.tissue.stiffness << 1, 0.9, -0.9, 0.9, 1, 0.9, -0.9, 0.9, 1;
  expect_refused("negative only as a whole");
  EXPECT_EQ(rig.state().phase, HapticPhase::active);
}

TEST_F(HostileTissue, WithTimesAheadOrBackIsRefused) {
  rig.working = false;
  for (const std::int64_t ahead : {-50'000'000, 5'000'000}) {
    const std::uint64_t before = rig.state().tissue_refused;
    rig.tissue = good;
    rig.tissue.sequence = 1000 + before;
    rig.tissue.posture_time = rig.now + Nanoseconds(ahead);
    rig.tissue.force_W = {0, 0, 5};
    rig.tick(Vector3d::Zero());
    rig.tick(Vector3d::Zero());
    EXPECT_NEAR(rig.force().z(), 1, 1e-9);
    EXPECT_EQ(rig.state().tissue_refused, before + 1) << "the same response is counted once";
  }
}

// --- A trocar: 150 mm from the pivot to the tip, the shaft upright.

struct TrocarRig : TissueRig {
  explicit TrocarRig(HapticSettings settings = plain_settings())
      : TissueRig(trocar([&settings] {
          settings.X_WD.translation() = Vector3d(0, 0, -0.15);
          return settings;
        }())) {
    q[2] = 0.15;
    model = model_of({}, Vector3d(0, 0, -0.15));
    tissue.x_ref = {0, 0, -0.15};
  }
};

TEST(TissueAtATrocar, TorqueAboutTheToolAxisReachesTheRollAndTheHandle) {
  TrocarRig rig;
  rig.tissue.force_W = {0, 0, 0.5};
  rig.tissue.torque_W = {0, 0, 0.02};
  rig.go({0, 0, 0}, kFadedIn);
  // The tool's z points downwards.
  EXPECT_NEAR(rig.state().axis_torque, -0.02, 1e-9);
  EXPECT_NEAR(rig.port.output.torque_D.z(), 0.02, 1e-9);
  EXPECT_NEAR(rig.state().joint_torques[3], -0.02, 1e-9);
  EXPECT_NEAR(rig.state().joint_torques[2], -0.5, 1e-9) << "pushes the instrument out";
  rig.tissue.force_W.setZero();
  rig.go({0, 0, 0});
  EXPECT_NEAR(rig.state().axis_torque, -0.02, 1e-9) << "without a force too";
  rig.tissue.torque_W = {0, 0, 90};
  rig.go({0, 0, 0}, 5);
  EXPECT_NEAR(rig.state().axis_torque, -rig.instrument.settings.max_force * 0.02, 1e-9) << "bounded";
}

TEST(TissueAtATrocar, ForceAtTheShaftIsFeltByItsLever) {
  TrocarRig rig;
  // 1 N in x at the middle of the shaft, 75 mm above the tip.
  rig.tissue.force_W = {1, 0, 0};
  rig.tissue.torque_W = Vector3d(0, 0, 0.075).cross(rig.tissue.force_W);
  rig.go({0, 0, 0}, kFadedIn);
  EXPECT_NEAR((rig.force() - Vector3d(0.5, 0, 0)).norm(), 0, 1e-6) << "half as far from the pivot as the tip";
  // The torque at the pivot is that of the force at its place.
  EXPECT_NEAR(rig.state().joint_torques.at(1), -0.075, 1e-6);
  EXPECT_NEAR(rig.state().joint_torques.at(0), 0, 1e-6);
}

TEST(TissueAtATrocar, JointTorquesHaveThePowerOfForceAndTorque) {
  TrocarRig rig;
  rig.tissue.force_W = {0.3, -0.2, 0.4};
  rig.tissue.torque_W = {0.005, -0.01, 0.002};
  rig.tissue.held = 1;
  rig.go({0, 0, 0}, kFadedIn);
  rig.go({0.02, 0.03, 0.01}, 10);
  rig.tissue.x_ref = rig.state().x_proxy;
  rig.go({0.02, 0.03, 0.01}, 10);
  kinematics::Jacobian J;
  JointValues values{};
  std::copy_n(rig.q.begin(), 4, values.begin());
  (void)kinematics::forward(rig.instrument.chain, std::span<const double>(values.data(), 4), J);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double power = J.col(i).head<3>().dot(rig.tissue.force_W) + J.col(i).tail<3>().dot(rig.tissue.torque_W);
    EXPECT_NEAR(rig.state().joint_torques[static_cast<std::size_t>(i)], power, 1e-6) << i;
  }
}

TEST(Tissue, TakesNoHeapMemory) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  TrocarRig rig;
  rig.tissue.force_W = {0.1, 0, 0.5};
  rig.tissue.torque_W = {0.01, 0, 0.01};
  rig.tissue.stiffness = 200 * Matrix3d::Identity();
  rig.go({0, 0, 0}, kFadedIn);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) rig.tick({0, 0, -1e-5 * i});
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_GT(rig.force().z(), 0.5);
}

}  // namespace
}  // namespace cellmirror::haptics
