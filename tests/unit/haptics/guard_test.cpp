// Each fault: zero force in the same tick, latched, told, and taken back only when its cause is gone.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>

#include "rig.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::model_of;
using test_rig::plain_settings;
using test_rig::plane;
using test_rig::Rig;
using test_rig::trocar;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Vector3d kPressed(0, 0, -0.004);

// Pressing 4 mm into a wall, so that there is a force to be taken away.
struct PressedRig : Rig {
  explicit PressedRig(const HapticSettings& settings = plain_settings(), const Instrument& made = gantry({}))
      : Rig(made) {
    instrument.settings = settings;
    model = model_of({plane(Vector3d::UnitZ(), 0, Vector3d::Zero())}, Vector3d::Zero());
    go({0, 0, 0.001});
    go(kPressed);
  }
  // Takes the fault back as soon as that is possible; false where it never is within 200 periods of good behaviour.
  bool mend() {
    for (int i = 0; i < 200; ++i) {
      tick(kPressed);
      if (sut.reset()) return true;
    }
    return false;
  }
};

struct Fault {
  const char* name;
  HapticFault expected;
  std::function<void(PressedRig&)> cause;  // ends with the tick in which the fault has to be seen
};

void broken_sample(PressedRig& rig, const std::function<void(HapticSample&)>& breaking) {
  rig.fresh();
  const HapticSample good = rig.port.sample;
  breaking(rig.port.sample);
  rig.tick();
  const std::uint64_t sequence = rig.port.sample.sequence;
  rig.port.sample = good;
  rig.port.sample.sequence = sequence;
}

void ticks(PressedRig& rig, int count, HapticRead read) {
  for (int i = 0; i < count; ++i) {
    rig.port.next = read;
    rig.tick();
  }
}

std::vector<Fault> faults() {
  std::vector<Fault> all = {
      {"silence", HapticFault::stale, [](PressedRig& rig) { ticks(rig, 5, HapticRead::unchanged); }},
      {"memory gone", HapticFault::stale, [](PressedRig& rig) { ticks(rig, 5, HapticRead::none); }},
      {"count stands still", HapticFault::stale,
       [](PressedRig& rig) {
         for (int i = 0; i < 5; ++i) {
           rig.fresh();
           --rig.port.sample.sequence;
           rig.tick();
         }
       }},
      {"old stamps", HapticFault::stale,
       [](PressedRig& rig) {
         broken_sample(rig, [](HapticSample& sample) { sample.time = sample.time - Nanoseconds{5'000'000}; });
       }},
      {"stamps of another clock", HapticFault::stale,
       [](PressedRig& rig) {
         broken_sample(rig, [](HapticSample& sample) { sample.time.ns = std::numeric_limits<std::int64_t>::max(); });
       }},
      {"stamps before time began", HapticFault::stale,
       [](PressedRig& rig) {
         broken_sample(rig, [](HapticSample& sample) { sample.time.ns = std::numeric_limits<std::int64_t>::min(); });
       }},
      {"process gone", HapticFault::vanished,
       [](PressedRig& rig) {
         rig.device_gone = true;
         rig.tick();
         rig.device_gone = false;
       }},
      {"says itself that it is bad", HapticFault::invalid,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.valid = false; }); }},
      {"axes that do not exist", HapticFault::invalid,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.axis_count = 200; }); }},
      {"a place outside of the world", HapticFault::invalid,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.p_DH.x() = 1e9; }); }},
      {"jump", HapticFault::jump,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.p_DH.x() += 0.02; }); }},
      {"second writer", HapticFault::two_writers,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.writer = 78; }); }},
      {"count goes back", HapticFault::two_writers,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.sequence -= 3; }); }},
      {"another writer far away, when the last sample has just turned old", HapticFault::stale,
       [](PressedRig& rig) {
         ticks(rig, 3, HapticRead::unchanged);
         ASSERT_EQ(rig.state().fault, HapticFault::none);
         broken_sample(rig, [](HapticSample& sample) {
           sample.writer = 78;
           sample.p_DH.x() += 0.3;
         });
       }},
      {"second writer in exact step", HapticFault::two_writers,
       [](PressedRig& rig) {
         for (const std::uint64_t writes : {10, 12}) {
           rig.port.sample.writes = writes;
           rig.tick(kPressed);
         }
         rig.port.sample.writes = 0;
       }},
      {"torn", HapticFault::torn, [](PressedRig& rig) { ticks(rig, 5, HapticRead::torn); }},
      {"late", HapticFault::late_tick,
       [](PressedRig& rig) {
         rig.missed = 3;
         rig.tick(kPressed);
         rig.missed = 0;
       }},
      {"old model", HapticFault::stale_model,
       [](PressedRig& rig) {
         rig.keep_model_new = false;
         for (int i = 0; i < 101; ++i) rig.tick(kPressed);
         rig.keep_model_new = true;
       }},
      {"no rotation", HapticFault::not_finite,
       [](PressedRig& rig) { broken_sample(rig, [](HapticSample& sample) { sample.q_DH.coeffs().setZero(); }); }},
  };
  const std::vector<std::function<double&(HapticSample&)>> places = {
      [](HapticSample& s) -> double& { return s.p_DH.x(); }, [](HapticSample& s) -> double& { return s.p_DH.z(); },
      [](HapticSample& s) -> double& { return s.q_DH.w(); }, [](HapticSample& s) -> double& { return s.q_DH.y(); },
      [](HapticSample& s) -> double& { return s.gripper; },  [](HapticSample& s) -> double& { return s.axes[0]; },
      [](HapticSample& s) -> double& { return s.axes[6]; },
  };
  for (const auto& place : places) {
    for (const double value : {kNaN, std::numeric_limits<double>::infinity()}) {
      all.push_back({"no number", HapticFault::not_finite, [place, value](PressedRig& rig) {
                       broken_sample(rig, [&](HapticSample& sample) {
                         sample.axis_count = kMaxHapticAxes;
                         place(sample) = value;
                       });
                     }});
    }
  }
  return all;
}

TEST(Guards, TakeTheForceAwayInTheSameTickAndLatch) {
  for (const Fault& fault : faults()) {
    PressedRig rig;
    ASSERT_NEAR(rig.port.output.force_D.z(), 4, 1e-6) << fault.name;
    fault.cause(rig);
    EXPECT_EQ(rig.state().phase, HapticPhase::faulted) << fault.name;
    EXPECT_EQ(rig.state().fault, fault.expected) << fault.name;
    EXPECT_EQ(rig.port.output.phase, static_cast<std::uint32_t>(HapticPhase::faulted)) << fault.name;
    EXPECT_EQ(rig.port.output.fault, static_cast<std::uint32_t>(fault.expected)) << fault.name;
    EXPECT_EQ(rig.port.output.force_D.norm() + rig.port.output.force_E.norm(), 0.0) << fault.name;
    EXPECT_EQ(rig.port.output.joint_torques, JointValues{}) << fault.name;
    EXPECT_FALSE(rig.sut.reset()) << fault.name << ": its cause was there just now";
    for (int i = 0; i < 60; ++i) {
      EXPECT_FALSE(rig.tick(kPressed)) << fault.name;
      EXPECT_EQ(rig.port.output.force_D.norm(), 0.0) << fault.name;
    }
    EXPECT_EQ(rig.state().fault, fault.expected) << fault.name << " is still what was met first";
    EXPECT_EQ(rig.state().faults, 1U);
    EXPECT_TRUE(rig.mend()) << fault.name;
    EXPECT_FALSE(rig.sut.reset()) << "nothing to take back any more";
    EXPECT_TRUE(rig.tick(kPressed)) << fault.name;
    EXPECT_EQ(rig.port.output.force_D.norm(), 0.0) << fault.name << ": no kick at the new beginning";
    rig.go({0, 0, 0.002});
    rig.go(kPressed);
    EXPECT_NEAR(rig.port.output.force_D.z(), 4, 1e-6) << fault.name;
  }
}

TEST(Guards, RefuseAResetWhileTheCauseLasts) {
  PressedRig rig;
  for (int i = 0; i < 100; ++i) {
    rig.port.sample.writer = i % 2 == 0 ? 77 : 78;
    rig.tick(kPressed);
    EXPECT_FALSE(rig.sut.reset());
  }
  EXPECT_EQ(rig.state().fault, HapticFault::two_writers);
  PressedRig silent;
  for (int i = 0; i < 100; ++i) silent.tick();
  EXPECT_FALSE(silent.sut.reset());
}

TEST(Guards, LetADeviceWriteAsOftenAsItCounts) {
  PressedRig rig;
  rig.port.sample.writes = 1000;  // of an earlier process too
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t more = i % 3 == 0 ? 2 : 0;  // written between two ticks
    rig.port.sample.writes += 1 + more;
    rig.port.sample.sequence += more;
    rig.tick(kPressed);
    ASSERT_EQ(rig.state().fault, HapticFault::none);
  }
}

TEST(Guards, TakeStaleForVanishedOnceItIsKnownBetter) {
  PressedRig rig;
  ticks(rig, 10, HapticRead::unchanged);
  EXPECT_EQ(rig.state().fault, HapticFault::stale);
  rig.device_gone = true;
  rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::vanished);
  EXPECT_EQ(rig.state().faults, 1U);
}

TEST(Guards, LetADeviceBeSlowerThanTheTickAndLoseASample) {
  PressedRig rig;
  for (int i = 0; i < 200; ++i) {
    if (i % 3 == 0) {
      rig.fresh();
      rig.port.sample.sequence += 4;
    }
    rig.tick();
    ASSERT_EQ(rig.state().fault, HapticFault::none);
    ASSERT_NEAR(rig.port.output.force_D.z(), 4, 1e-6);
  }
  EXPECT_EQ(rig.state().skipped, 4U * 67U);
}

TEST(Guards, CountTheAgeOfASampleFromItsMeasurement) {
  PressedRig rig;
  rig.fresh();
  rig.port.sample.time = rig.now - Nanoseconds{1'000'000};  // 2 ms old when it is read
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::none);
  rig.tick();
  ASSERT_EQ(rig.state().fault, HapticFault::none) << "3 ms";
  rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::stale) << "4 ms old, though it was read 2 ms ago";
}

TEST(Guards, TakeAnotherModelOfTheSamePosture) {
  PressedRig rig;
  rig.keep_model_new = false;
  ++rig.model.sequence;  // the cell was changed in between
  rig.model.constraints[0] = plane(Vector3d::UnitZ(), -0.002, Vector3d::Zero());
  rig.tick(kPressed);
  rig.tick(kPressed);
  EXPECT_NEAR(rig.port.output.force_D.z(), 2, 1e-6) << "the wall is 2 mm lower";
}

TEST(Guards, TakeAModelWithAsManyConstraintsAsFitAndNoMore) {
  PressedRig rig;
  const ContactConstraint wall = plane(Vector3d::UnitZ(), -0.001, Vector3d::Zero());
  const auto lower = [&](std::size_t count) {
    rig.model.count = static_cast<std::uint8_t>(count);
    for (ContactConstraint& constraint : rig.model.constraints) constraint = wall;
    rig.tick(kPressed);
    rig.tick(kPressed);
    return rig.port.output.force_D.z();
  };
  EXPECT_NEAR(lower(kMaxConstraints + 1), 4, 1e-6) << "makes no sense: the last good one counts";
  EXPECT_NEAR(lower(kMaxConstraints), 3, 1e-6);
}

TEST(Guards, WaitForADeviceThatIsNotReady) {
  Rig rig(gantry(plain_settings()));
  rig.tick();
  EXPECT_EQ(rig.state().phase, HapticPhase::waiting);
  rig.fresh();
  rig.port.sample.time = Timestamp{1};  // left in the memory by a device that has been gone for long
  EXPECT_FALSE(rig.tick());
  rig.fresh();
  rig.port.sample.valid = false;
  EXPECT_FALSE(rig.tick());
  EXPECT_EQ(rig.state().phase, HapticPhase::waiting);
  rig.port.sample.valid = true;
  EXPECT_TRUE(rig.tick(Vector3d::Zero()));
}

TEST(Guards, LetTheModelBeMissingAsLongAsNoneEverCame) {
  Rig rig(gantry(plain_settings()));
  rig.show_model = false;
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(rig.tick({0, 0, -1e-4 * i}));
  EXPECT_EQ(rig.state().fault, HapticFault::none);
  rig.show_model = true;
  EXPECT_TRUE(rig.tick({0, 0, -0.03}));
  rig.show_model = false;
  for (int i = 0; i < 101; ++i) rig.tick({0, 0, -0.03});
  EXPECT_EQ(rig.state().fault, HapticFault::stale_model);
}

TEST(Guards, TakeNoModelThatMakesNoSense) {
  PressedRig rig;
  rig.model.constraints[0].gap = kNaN;
  for (int i = 0; i < 99; ++i) {
    rig.tick(kPressed);
    ASSERT_NEAR(rig.port.output.force_D.z(), 4, 1e-6) << "the last good one counts until it is old";
  }
  for (int i = 0; i < 3; ++i) rig.tick(kPressed);
  EXPECT_EQ(rig.state().fault, HapticFault::stale_model);
}

TEST(Clutch, UncouplesAndTakesHoldAgainWithoutAJump) {
  HapticSettings settings = plain_settings();
  settings.clutch_button = 1;
  PressedRig rig(settings);
  const JointValues before = rig.q;
  rig.port.sample.buttons = 0b10;
  rig.tick(kPressed);
  EXPECT_EQ(rig.state().phase, HapticPhase::clutched);
  EXPECT_EQ(rig.port.output.force_D.norm(), 0.0);
  rig.go({0.05, 0.02, -0.03});
  EXPECT_EQ(rig.q, before);
  rig.port.sample.buttons = 0;
  rig.tick({0.05, 0.02, -0.03});
  EXPECT_NEAR(rig.q[0], before[0], 1e-9);
  EXPECT_EQ(rig.port.output.force_D.norm(), 0.0);
  rig.go({0.06, 0.02, -0.03});
  EXPECT_NEAR(rig.q[0], before[0] + 0.01, 1e-9);
  rig.go({0.06, 0.02, -0.033});
  EXPECT_NEAR(rig.port.output.force_D.z(), 3, 1e-6) << "the wall begins where the hand took hold";
}

TEST(Mapping, OfATrocarPutsTheTipWhereTheHandIsAndLeavesTheRollToTheHandle) {
  HapticSettings settings = plain_settings();
  settings.X_WD.translation() = Vector3d(0, 0, -0.15);
  settings.gripper_joint = 4;
  settings.gripper_scale = 0.5;
  Rig rig(trocar(settings));
  rig.q[2] = 0.15;
  rig.go({0, 0, 0});
  rig.go({0.05, -0.03, -0.02}, 5);
  const auto tip = [&] { return Pose(rig.instrument.X_WB * kinematics::forward(rig.instrument.chain, rig.q)); };
  EXPECT_NEAR((tip().translation() - Vector3d(0.05, -0.03, -0.17)).norm(), 0, 1e-8);
  EXPECT_NEAR((rig.state().x_proxy - tip().translation()).norm(), 0, 1e-8);
  const double roll = rig.q[3];
  // Turning the handle about the shaft turns the roll by as much.
  const Vector3d shaft = tip().translation().normalized();
  rig.port.sample.gripper = 0.8;
  for (int i = 1; i <= 100; ++i) {
    rig.port.sample.q_DH = Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * i, shaft));
    rig.tick({0.05, -0.03, -0.02});
  }
  rig.go({0.05, -0.03, -0.02}, 5);
  EXPECT_NEAR(std::abs(rig.q[3] - roll), 1.0, 1e-4);
  EXPECT_NEAR((tip().translation() - Vector3d(0.05, -0.03, -0.17)).norm(), 0, 1e-8);
  EXPECT_NEAR(rig.q[4], 0.4, 1e-12) << "the jaw";
}

TEST(Mapping, KeepsWithinTheLimitsOfTheJoints) {
  HapticSettings settings = plain_settings();
  settings.X_WD.translation() = Vector3d(0, 0, -0.15);
  Rig rig(trocar(settings));
  rig.q[2] = 0.15;
  for (const Vector3d& p : {Vector3d(0, 0, -0.4), Vector3d(0.5, 0, 0.1), Vector3d(0, 0, 0.4), Vector3d(-0.3, 0.4, 0)}) {
    rig.go(p, 20);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_GE(rig.q[i], rig.instrument.lower[i]);
      EXPECT_LE(rig.q[i], rig.instrument.upper[i]);
    }
    EXPECT_EQ(rig.state().fault, HapticFault::none);
  }
  rig.go({0.02, 0, 0}, 20);
  EXPECT_NEAR((rig.state().x_proxy - Vector3d(0.02, 0, -0.15)).norm(), 0, 1e-6) << "and comes back";
}

TEST(Mapping, OfAxesLeavesOutTheJointOfTheGripper) {
  HapticSettings settings = plain_settings();
  settings.drive = Drive::joints;
  settings.max_speed = 100;
  settings.gripper_joint = 1;  // in the middle: PITCH
  Rig rig(trocar(settings));
  rig.q[2] = 0.15;
  rig.port.sample.axis_count = 4;
  rig.port.sample.axes = {0.01, 0.16, 0.02, 0.3};
  rig.port.sample.gripper = 0.05;
  for (int i = 0; i < 500; ++i) rig.tick(Vector3d::Zero());
  const std::array<double, 5> expected = {0.01, 0.05, 0.16, 0.02, 0.3};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(rig.q[i], expected[i], 1e-6) << i;
}

TEST(Engagement, InFreeAirNeedsNoSecondModel) {
  Rig rig(gantry(plain_settings()));
  rig.model = model_of({plane(Vector3d::UnitZ(), -1, Vector3d::Zero())}, Vector3d::Zero());
  rig.keep_model_new = false;
  rig.model.posture_time = rig.now;
  for (int i = 0; i < 50; ++i) rig.tick(Vector3d::Zero());
  EXPECT_EQ(rig.state().phase, HapticPhase::active) << "two models have to agree on a contact alone";
}

TEST(Passivity, WhatFrictionHasTakenIsNoCredit) {
  const PassivitySettings settings{.control = true, .allowance = 1e-3, .max_damping = 1000};
  Passivity sut;
  sut.restart(Vector3d::Zero());
  const Vector3d against(0, 0, 2.0);  // N, while the hand goes down: work goes in
  double depth = 0;
  for (int i = 0; i < 100; ++i) {
    depth -= 1e-4;
    sut.observe({0, 0, depth}, against, 1e-4, settings, 1e-3);
  }
  EXPECT_LE(sut.energy(), 1e-4) << "20 mJ went in, and the spring holds a tenth of one";
  EXPECT_GT(sut.energy(), 0.0);
}

TEST(Passivity, ASpringAtTheForceLimitGivesBackNoMoreThanItTook) {
  HapticSettings settings = plain_settings();
  settings.max_force = 8;
  settings.static_friction = settings.dynamic_friction = 0.3;
  PressedRig rig(settings);
  rig.go({0, 0, -0.05});
  // 8 mm of the spring, then 42 mm at 8 N.
  EXPECT_NEAR(rig.state().energy, 0.5 * 1000 * 0.008 * 0.008 + 8 * 0.042, 0.01);
  rig.go({0.3, 0, -0.05});  // friction takes 0.7 J
  EXPECT_LT(rig.state().energy, 0.45);
}

TEST(Mapping, OfAxesToJointsStopsAtWallsToo) {
  HapticSettings settings = plain_settings();
  settings.drive = Drive::joints;
  Rig rig(trocar(settings));
  rig.model = model_of({plane(Vector3d::UnitZ(), -0.2, Vector3d(0, 0, -0.15))}, Vector3d(0, 0, -0.15));
  rig.q[2] = 0.15;
  rig.port.sample.axis_count = 4;
  rig.port.sample.q_DH.coeffs().setZero();  // a device of axes has no orientation to tell
  const auto hold = [&](double yaw, double pitch, double insertion, double roll) {
    for (int i = 0; i < 400; ++i) {
      auto& axes = rig.port.sample.axes;
      const std::array<double, 4> aim = {yaw, pitch, insertion, roll};
      for (std::size_t k = 0; k < 4; ++k) axes[k] += std::clamp(aim[k] - axes[k], -5e-4, 5e-4);
      rig.tick(Vector3d::Zero());
    }
  };
  rig.port.sample.axes[2] = 0.15;
  hold(0.1, -0.1, 0.17, 0.15);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(rig.q[i], rig.port.sample.axes[i], 1e-9) << i;
  hold(0, 0, 0.203, 0.15);
  EXPECT_NEAR(rig.q[2], 0.2, 1e-7);
  EXPECT_NEAR(rig.q[3], 0.15, 1e-4);
  EXPECT_NEAR(rig.port.output.joint_torques[2], -3, 1e-3) << "pushes the insertion out, which is along -z";
  EXPECT_NEAR(rig.state().force_E.norm(), 3, 1e-3);
}

TEST(Channel, LeavesTheHeapAlone) {
  PressedRig rig(plain_settings());
  const AllocationGuard guard;
  for (int i = 0; i < 200; ++i) rig.tick({1e-4 * i, 0, -0.004});
  rig.tick();
  rig.device_gone = true;
  rig.tick();
  rig.sut.reset();
  rig.sut.close();
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

TEST(Channel, ClosesWithAForceOfZero) {
  PressedRig rig;
  rig.sut.close();
  EXPECT_FALSE(rig.sut.used());
  EXPECT_EQ(rig.port.output.force_D.norm(), 0.0);
  EXPECT_EQ(rig.port.output.phase, static_cast<std::uint32_t>(HapticPhase::closed));
  EXPECT_FALSE(rig.tick(kPressed));
  EXPECT_FALSE(rig.sut.reset());
}

}  // namespace
}  // namespace cellmirror::haptics
