// Surroundings that come late, bodies that are put onto the tip, and instruments that are exchanged: none of them
// pushes the hand. What moves into it does.
#include <gtest/gtest.h>

#include <algorithm>

#include "rig.hpp"
#include "rt_core/haptics/appearance.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/rt/allocation_guard.hpp"

namespace cellmirror::haptics {
namespace {

using Eigen::Vector3d;
using test_rig::gantry;
using test_rig::model_of;
using test_rig::plain_settings;
using test_rig::plane;
using test_rig::Rig;

const Vector3d kHere = Vector3d::Zero();

ContactModel nothing_near() { return model_of({}, kHere); }
// Free above `height`.
ContactModel floor_at(double height) { return model_of({plane(Vector3d::UnitZ(), height, kHere)}, kHere); }

// A gantry whose worker finds what show() says, for the cell of that number.
struct FreeRig : Rig {
  explicit FreeRig(const HapticSettings& settings = plain_settings()) : Rig(gantry(settings)) {}
  void show(const ContactModel& found, std::uint64_t cell = 0) {
    const std::uint64_t sequence = model.sequence;
    const Timestamp posture_time = model.posture_time;
    model = found;
    model.sequence = sequence;
    model.posture_time = posture_time;
    model.cell = cell;
  }
  [[nodiscard]] double force() const { return port.output.force_D.norm(); }
};

HapticSettings ordinary_settings() {
  HapticSettings settings;
  settings.stiffness = 3000;
  return settings;
}

TEST(FirstSurroundings, AreWaitedForWithoutAForceAndWithoutAMotion) {
  FreeRig rig;
  rig.show(floor_at(0));
  rig.show_model = false;
  for (int i = 1; i <= 100; ++i) {
    ASSERT_FALSE(rig.tick({0, 0, -1e-4 * i}));
    ASSERT_EQ(rig.state().phase, HapticPhase::waiting);
    ASSERT_TRUE(rig.state().awaits_surroundings);
    ASSERT_EQ(rig.force(), 0.0);
  }
  rig.show_model = true;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(rig.tick({0, 0, -0.01}));
    ASSERT_EQ(rig.force(), 0.0) << "the surface was passed before it was known";
    ASSERT_FALSE(rig.state().awaits_surroundings);
  }
  EXPECT_NEAR(rig.state().x_proxy.z(), 0, 1e-9);
}

TEST(FirstSurroundings, AreNotWhatTheHandWaitsForWhileThereIsNoDevice) {
  FreeRig rig;
  rig.show_model = false;
  for (int i = 0; i < 50; ++i) rig.tick();
  EXPECT_EQ(rig.state().phase, HapticPhase::waiting);
  EXPECT_FALSE(rig.state().awaits_surroundings);
}

TEST(FirstSurroundings, DoNotCountOnceTheyAreOld) {
  FreeRig rig;
  rig.tick();
  rig.keep_model_new = false;
  for (int i = 0; i < 150; ++i) rig.tick();
  EXPECT_FALSE(rig.tick(kHere));
  EXPECT_TRUE(rig.state().awaits_surroundings);
  EXPECT_EQ(rig.state().fault, HapticFault::none);
  rig.keep_model_new = true;
  EXPECT_TRUE(rig.tick(kHere));
}

// The worst that a program may do: 20 mm of a stiff body, all at once, onto a hand that holds still.
TEST(BodyThatAppears, IsNotFeltUntilItWasLeft) {
  for (const std::uint64_t cell : {0, 1}) {
    FreeRig rig(ordinary_settings());
    rig.go(kHere, 500);
    ASSERT_EQ(rig.state().phase, HapticPhase::active);
    rig.show(floor_at(0.02), cell);
    for (int i = 0; i < 1000; ++i) {
      ASSERT_TRUE(rig.tick(kHere));
      ASSERT_EQ(rig.force(), 0.0) << i;
    }
    EXPECT_EQ(rig.state().appeared, 1U);
    EXPECT_NEAR(rig.state().x_proxy.z(), 0.02, 1e-9) << "the instrument does not stay inside";
    rig.go({0, 0, 0.021});
    EXPECT_EQ(rig.force(), 0.0) << "nor is it felt on the way out";
    rig.go({0, 0, 0.018}, 300);
    EXPECT_NEAR(rig.force(), 6, 0.1) << "from outside it is a body as any other";
  }
}

TEST(BodyThatAppears, IsPressedOnlyAsTheForceFadesIn) {
  HapticSettings settings = plain_settings();
  settings.engage_time = Nanoseconds{300'000'000};
  FreeRig rig(settings);
  rig.go(kHere, 500);
  rig.show(floor_at(0.02));
  rig.tick(kHere);
  EXPECT_EQ(rig.state().phase, HapticPhase::engaging);
  rig.go(kHere, 20);
  double last = 0;
  for (int i = 1; i <= 100; ++i) {
    const double pressed = 5e-5 * i;  // m, beyond where it appeared: 0.05 m/s
    rig.tick({0, 0, -pressed});
    const double share = (i + 20) / 300.0;
    EXPECT_LE(rig.force(), settings.stiffness * pressed * share + 1e-9) << i;
    EXPECT_LE(rig.force() - last, 0.05) << i << ": N in a millisecond";
    last = rig.force();
  }
  EXPECT_GT(last, 1.0) << "which is felt all the same";
}

TEST(BodyThatAppears, TakesTheForceOfOtherContactsAwayAtOnce) {
  FreeRig rig;
  rig.show(floor_at(0));
  rig.go({0, 0, 0.001});
  rig.go({0, 0, -0.004});
  ASSERT_NEAR(rig.force(), 4, 1e-6);
  const auto wall = plane(Vector3d::UnitX(), 0.01, kHere);
  rig.show(model_of({plane(Vector3d::UnitZ(), 0, kHere), wall}, kHere), 1);
  for (int i = 0; i < 100; ++i) {
    rig.tick({0, 0, -0.004});
    ASSERT_EQ(rig.force(), 0.0);
  }
  rig.go({0.011, 0, 0.001});
  rig.go({0.011, 0, -0.004});
  EXPECT_NEAR(rig.force(), 4, 1e-6);
}

TEST(BodyThatAppears, WhileTheClutchIsPressedIsMetAsAtEveryEngagement) {
  HapticSettings settings = plain_settings();
  settings.clutch_button = 0;
  FreeRig rig(settings);
  rig.go(kHere);
  rig.port.sample.buttons = 1;
  rig.tick(kHere);
  rig.show(floor_at(0.02), 1);
  rig.tick(kHere);
  EXPECT_EQ(rig.state().phase, HapticPhase::clutched);
  rig.port.sample.buttons = 0;
  for (int i = 0; i < 200; ++i) {
    rig.tick(kHere);
    ASSERT_EQ(rig.force(), 0.0);
  }
}

TEST(BodyThatAppears, AgainAndAgainNeverPushes) {
  FreeRig rig(ordinary_settings());
  rig.go(kHere, 500);
  for (int i = 0; i < 2000; ++i) {
    rig.show(i / 37 % 2 == 0 ? floor_at(0.01) : nothing_near(), static_cast<std::uint64_t>(i / 37));
    rig.tick(kHere);
    ASSERT_EQ(rig.force(), 0.0) << i;
  }
  EXPECT_GT(rig.state().appeared, 20U);
}

struct Approach {
  const char* name;
  double speed;      // m/s
  int every;         // periods between two models
  bool by_commands;  // the cell changes with every model
  double end;        // m, beyond the tip
  bool felt;
};

// The body starts 3 mm away from the tip and ends beyond it; the hand holds still.
double force_of(const Approach& approach, std::uint64_t& appeared) {
  FreeRig rig;
  rig.keep_model_new = false;
  double height = -0.003;
  int tick = 0;
  const auto one = [&] {
    if (tick % approach.every == 0) {
      rig.show(floor_at(height), approach.by_commands ? static_cast<std::uint64_t>(tick) : 0);
      ++rig.model.sequence;
      rig.model.posture_time = rig.now + rig.period;
    }
    rig.tick(kHere);
    ++tick;
  };
  for (int i = 0; i < 50; ++i) one();
  while (height < approach.end) {
    height = std::min(approach.end, height + approach.speed * 1e-3);
    one();
  }
  for (int i = 0; i < 50; ++i) one();
  appeared = rig.state().appeared;
  return rig.force();
}

TEST(BodyThatMoves, PushesAsLongAsItsSpeedExplainsWhereItIs) {
  const std::vector<Approach> approaches = {
      {"a robot, a model in each period", 0.1, 1, false, 0.004, true},
      {"a robot, a model in ten periods", 0.1, 10, false, 0.004, true},
      {"a quick robot", 0.4, 10, false, 0.004, true},
      {"a quick robot, a slow worker", 0.25, 20, false, 0.004, true},
      {"a program that moves it by commands", 0.1, 10, true, 0.004, true},
      {"as fast as no body should be", 1.0, 10, false, 0.007, false},
  };
  for (const Approach& approach : approaches) {
    std::uint64_t appeared = 0;
    const double force = force_of(approach, appeared);
    EXPECT_NEAR(force, approach.felt ? 4.0 : 0.0, 1e-6) << approach.name;
    EXPECT_EQ(appeared == 0, approach.felt) << approach.name;
  }
}

bool appeared(const ContactModel& before, const ContactModel& now, const Vector3d& x) {
  return AppearanceWatch().appeared(before, now, x);
}

TEST(Appearance, ComparesTheDepthsInTheSamePlace) {
  ContactModel before = floor_at(0);
  ContactModel now = floor_at(0.004);
  now.posture_time = before.posture_time + Nanoseconds{1'000'000};
  EXPECT_NEAR(tip_depth(now, kHere), 0.004, 1e-12);
  EXPECT_TRUE(appeared(before, now, kHere));
  EXPECT_FALSE(appeared(before, now, {0, 0, 0.0035})) << "the tip is elsewhere";
  EXPECT_FALSE(appeared(now, now, kHere)) << "it was inside already";
  before.count = 0;
  EXPECT_TRUE(appeared(before, now, kHere));
  now.constraints[0].a *= 0.1;  // a contact near the pivot: its depth is ten times as much for the tip
  now.constraints[0].gap = -0.0004;
  EXPECT_NEAR(tip_depth(now, kHere), 0.004, 1e-12);
  EXPECT_TRUE(appeared(before, now, kHere));
}

TEST(Appearance, IsNotExplainedByATimeInWhichTheCellWasChanged) {
  ContactModel before = floor_at(-0.001);
  before.posture_time = Timestamp{1'000'000'000};
  ContactModel now = floor_at(0.004);
  now.cell = 1;
  now.posture_time = before.posture_time + Nanoseconds{90'000'000};
  EXPECT_TRUE(appeared(before, now, kHere));
  now.posture_time = before.posture_time - Nanoseconds{90'000'000};
  EXPECT_TRUE(appeared(before, now, kHere)) << "times that go back explain nothing";
}

TEST(Appearance, BitByBitAddsUp) {
  AppearanceWatch sut;
  ContactModel before = floor_at(0);
  before.posture_time = Timestamp{1'000'000'000};
  bool found = false;
  for (int i = 1; i <= 10 && !found; ++i) {
    ContactModel now = floor_at(1e-3 * i);  // less at a time than a step may be, but 1 m/s
    now.posture_time = before.posture_time + Nanoseconds{1'000'000};
    found = sut.appeared(before, now, kHere);
    before = now;
  }
  EXPECT_TRUE(found);
}

// What lies deep around the tip shows bit by bit, as the instrument goes out of it.
TEST(BodyThatAppears, InStagesIsNotFeltEither) {
  FreeRig rig(ordinary_settings());
  rig.go(kHere, 500);
  for (int i = 0; i < 500; ++i) {
    rig.show(floor_at(std::min(0.02, rig.state().x_proxy.z() + (i == 0 ? 0.003 : 0.0007))), 1);
    rig.tick(kHere);
    ASSERT_EQ(rig.force(), 0.0) << i;
  }
  EXPECT_NEAR(rig.state().x_proxy.z(), 0.02, 1e-9);
}

TEST(ModelOfAnotherToolCentrePoint, IsNotTaken) {
  FreeRig rig;
  rig.model.joint_count = 5;
  rig.go(kHere);
  const ContactModel own = rig.model;
  for (int i = 0; i < 50; ++i) {
    rig.show(model_of({}, {0, 0, 0.05}));  // where the tip would be with it
    rig.model.joint_count = 5;
    rig.model.reach = 0.01;
    rig.tick(kHere);
    ASSERT_LT(rig.state().x_proxy.norm(), 1e-9) << "the instrument would twitch";
  }
  rig.show(own);
  rig.tick(kHere);
  EXPECT_EQ(rig.state().model_time, rig.now);
}

Instrument longer_gantry() {
  Instrument other = gantry(plain_settings());
  other.X_WB.translation().z() = 0.05;
  return other;
}

TEST(ExchangedInstrument, WaitsForItsOwnSurroundings) {
  const Instrument other = longer_gantry();
  FreeRig rig;
  rig.model.joint_count = 5;
  rig.go(kHere);
  rig.sut.exchange(other);
  for (int i = 0; i < 50; ++i) {
    ASSERT_FALSE(rig.tick(kHere));
    ASSERT_TRUE(rig.state().awaits_surroundings);
  }
  rig.show(model_of({}, {0, 0, 0.05}));
  rig.model.joint_count = 5;
  EXPECT_TRUE(rig.tick(kHere));
  rig.sut.close();
}

TEST(ExchangedInstrument, KeepsALatchedFault) {
  const Instrument other = longer_gantry();
  FreeRig rig;
  rig.go(kHere);
  rig.device_gone = true;
  rig.tick(kHere);
  ASSERT_EQ(rig.state().fault, HapticFault::vanished);
  rig.device_gone = false;
  rig.sut.exchange(other);
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(rig.tick(kHere));
  EXPECT_EQ(rig.state().fault, HapticFault::vanished);
  EXPECT_EQ(rig.state().faults, 1U);
  EXPECT_TRUE(rig.sut.reset());
  EXPECT_TRUE(rig.tick(kHere));
  rig.sut.close();
}

TEST(ExchangedInstrument, IsWatchedWhileItWaits) {
  const Instrument other = longer_gantry();
  FreeRig rig;
  rig.show_model = false;
  rig.sut.exchange(other);
  for (int i = 0; i < 50; ++i) rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::none) << "that never had engaged";
  rig.show_model = true;
  rig.go(kHere);
  rig.show_model = false;
  rig.sut.exchange(rig.instrument);
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_EQ(rig.state().fault, HapticFault::stale);
  rig.sut.close();
}

TEST(ExchangedInstrument, KeepsWhatTheClutchHasAdded) {
  HapticSettings settings = plain_settings();
  settings.clutch_button = 0;
  Instrument other = gantry(settings);
  other.upper[0] = 0.4;
  FreeRig rig(settings);
  rig.go(kHere);
  rig.port.sample.buttons = 1;
  rig.go({0.05, 0, 0});
  rig.port.sample.buttons = 0;
  rig.go({0.05, 0, 0});
  ASSERT_NEAR(rig.q[0], 0, 1e-9);
  rig.sut.exchange(other);
  rig.go({0.06, 0, 0}, 20);
  EXPECT_NEAR(rig.q[0], 0.01, 1e-9) << "the hand is not to find the tip elsewhere";
  Instrument elsewhere = other;
  elsewhere.settings.X_WD.translation().x() = 0.1;
  rig.sut.exchange(elsewhere);
  rig.go({0.06, 0, 0}, 100);
  EXPECT_NEAR(rig.q[0], 0.16, 1e-9) << "a device that lies elsewhere begins with the cell file's place";
  rig.sut.close();
}

TEST(Appearance, AndExchangeLeaveTheHeapAlone) {
  const Instrument other = longer_gantry();
  FreeRig rig;
  rig.go(kHere);
  const ContactModel inside = floor_at(0.02);
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  {
    const AllocationGuard guard;
    rig.show(inside, 1);
    for (int i = 0; i < 50; ++i) rig.tick(kHere);
    rig.sut.exchange(other);
    for (int i = 0; i < 50; ++i) rig.tick(kHere);
    rig.sut.close();
    EXPECT_EQ(guard.allocations(), 0U);
    EXPECT_EQ(guard.frees(), 0U);
  }
  EXPECT_EQ(rig.state().phase, HapticPhase::closed);
}

}  // namespace
}  // namespace cellmirror::haptics
