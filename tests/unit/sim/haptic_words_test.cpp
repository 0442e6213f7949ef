// Motions, faults and switch sequences as people write them; and what faults do to samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim_devices/base/text_items.hpp"
#include "sim_devices/footswitch/switch_bits.hpp"
#include "sim_devices/footswitch/switch_plan.hpp"
#include "sim_devices/haptic/command_line.hpp"
#include "sim_devices/haptic/haptic_fault.hpp"
#include "sim_devices/haptic/latency.hpp"
#include "sim_devices/haptic/motion_script.hpp"

namespace cellmirror::sim {
namespace {

std::vector<MotionStep> motion(std::string_view text, std::size_t axes = 6) {
  Diagnostics diagnostics;
  auto steps = parse_motion(text, "m", AxisLayout(axes), diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  return steps;
}

std::string refusal(std::string_view text, std::size_t axes = 6) {
  Diagnostics diagnostics;
  static_cast<void>(parse_motion(text, "m", AxisLayout(axes), diagnostics));
  return diagnostics.text();
}

TEST(MotionScript, ReadsAListOfSteps) {
  const auto sut = motion("touch z -0.03 speed=0.02; press 2s; drag x 0.02 ; letgo");
  ASSERT_EQ(sut.size(), 4U);
  EXPECT_EQ(sut[0].verb, MotionVerb::touch);
  EXPECT_DOUBLE_EQ(sut[0].direction[2], -1);
  EXPECT_DOUBLE_EQ(sut[0].amount, 0.03);
  EXPECT_DOUBLE_EQ(sut[0].speed, 0.02);
  EXPECT_EQ(sut[1].verb, MotionVerb::press);
  EXPECT_DOUBLE_EQ(sut[1].duration_s, 2);
  EXPECT_GT(sut[1].amount, 0);
  EXPECT_DOUBLE_EQ(sut[2].direction[0], 1);
  EXPECT_EQ(sut[3].verb, MotionVerb::letgo);
}

TEST(MotionScript, DirectionsAreAxesOrVectors) {
  const auto sut = motion("drag -y 0.01; drag 3,0,-4 0.01; drag rz 0.1\ndrag x 1 # comment; drag x 2");
  ASSERT_EQ(sut.size(), 4U);
  EXPECT_DOUBLE_EQ(sut[0].direction[1], -1);
  EXPECT_DOUBLE_EQ(sut[1].direction[0], 0.6);
  EXPECT_DOUBLE_EQ(sut[1].direction[2], -0.8);
  EXPECT_DOUBLE_EQ(sut[2].direction[5], 1);
  EXPECT_DOUBLE_EQ(motion("touch insertion 0.05; drag jaw 0.3", 5)[1].direction[4], 1);
}

TEST(MotionScript, TellsAllThatIsWrongWithItsPlace) {
  const std::string told = refusal("tuch z 1; hold\npress 2s 3 4; circle x x 1; button 40 on; drag yaw 1");
  EXPECT_NE(told.find("m:1:1: error: there is no motion 'tuch'; did you mean touch?"), std::string::npos) << told;
  EXPECT_NE(told.find("m:2:12: error: '4' does not belong to press"), std::string::npos) << told;
  EXPECT_NE(told.find("m:2:15: error: the circle's two directions"), std::string::npos) << told;
  EXPECT_NE(told.find("buttons 1 to 32"), std::string::npos) << told;
  EXPECT_NE(told.find("'yaw' does not belong to drag"), std::string::npos) << told;
}

TEST(MotionScript, RefusesWhatIsOutOfBounds) {
  for (const char* bad :
       {"drag x", "drag 0.1", "drag x 11", "drag 0,0,0 1", "drag x 1 speed=0", "drag x 1 speed=nan", "tap x 1 times=0",
        "tap x 1 times=1.5", "sine x 1 period=0s", "hold 2", "hold -1s", "press x 1", "drag x 1 for=1s", "circle x 0.1",
        "drag gripper 1", "button 0 on", "button 1"}) {
    EXPECT_NE(refusal(bad), "") << bad;
  }
  std::string long_list;
  for (std::size_t i = 0; i <= kMaxMotionSteps; ++i) long_list += "hold;";
  EXPECT_NE(refusal(long_list), "");
  EXPECT_NE(refusal(std::string(kMaxMotionText + 1, ' ')), "");
}

TEST(HapticFault, ReadsKindValueAndWindow) {
  const auto sut = parse_haptic_fault("jump:by=0.2@3..4.5");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->kind, HapticFaultKind::jump);
  EXPECT_DOUBLE_EQ(sut->by, 0.2);
  EXPECT_DOUBLE_EQ(sut->from_s, 3);
  EXPECT_DOUBLE_EQ(sut->until_s, 4.5);
  EXPECT_TRUE(std::isinf(parse_haptic_fault("dead@3")->until_s));
  for (const char* bad : {"", "dad", "jump:by", "jump:by=", "jump:by=-1", "jump:s=1", "late:by=1", "nan:by=1", "dead@",
                          "dead@-1", "dead@4..3", "dead@nan", "dead@1..x", "jump:by=1,"}) {
    EXPECT_FALSE(parse_haptic_fault(bad)) << bad;
  }
}

TEST(HapticFault, EveryKindIsReadByItsOwnName) {
  for (int i = 0; i <= static_cast<int>(HapticFaultKind::unbounded); ++i) {
    const auto kind = static_cast<HapticFaultKind>(i);
    const auto sut = parse_haptic_fault(std::string(name_of(kind)));
    ASSERT_TRUE(sut) << name_of(kind);
    EXPECT_EQ(sut->kind, kind);
    EXPECT_NE(haptic_fault_help().find(name_of(kind)), std::string::npos);
  }
}

TEST(HapticFault, ChangesValuesAsItsNameSays) {
  HapticSample before;
  before.p_DH = {9, 9, 9};
  HapticSample healthy;
  healthy.valid = true;
  healthy.axis_count = 6;
  healthy.time = Timestamp{1'000'000'000};
  const auto struck = [&](const char* text) {
    HapticSample sample = healthy;
    strike(*parse_haptic_fault(text), before, sample);
    return sample;
  };
  EXPECT_EQ(struck("stuck").p_DH.x(), 9);
  EXPECT_DOUBLE_EQ(struck("jump:by=0.1").p_DH.z(), 0.1);
  EXPECT_DOUBLE_EQ(struck("jump:by=0.1").axes[3], 0.1);
  EXPECT_TRUE(std::isnan(struck("nan").p_DH.y()));
  EXPECT_EQ(struck("rotation").q_DH.norm(), 0);
  EXPECT_EQ(struck("late:s=0.5").time.ns, 500'000'000);
  EXPECT_FALSE(struck("invalid").valid);
  EXPECT_GT(struck("unbounded").axes[0], 1e200);
  EXPECT_TRUE(struck("dead").valid);
}

TEST(DurationHistogram, GivesQuantilesAndTheExactLargest) {
  DurationHistogram sut;
  EXPECT_EQ(sut.quantile_us(0.5), 0);
  for (int i = 1; i <= 100; ++i) sut.add(Nanoseconds(i * 10'000 - 1));
  sut.add(Nanoseconds(500'000'000));
  EXPECT_NEAR(sut.quantile_us(0.5), 510, 1e-9);
  EXPECT_NEAR(sut.quantile_us(0.98), 990, 1e-9);
  EXPECT_NEAR(sut.max_us(), 500'000, 1e-9);
  sut.add(Nanoseconds(-5));
  EXPECT_EQ(sut.count(), 102U);
}

TEST(WriteTimes, ForgetsWhatIsLongAgo) {
  WriteTimes sut;
  for (std::uint64_t i = 1; i <= 2000; ++i) sut.note(i, Timestamp{static_cast<std::int64_t>(i)});
  EXPECT_EQ(sut.of(2000).ns, 2000);
  EXPECT_FALSE(sut.of(900).known());
  EXPECT_FALSE(sut.of(3000).known());
}

std::vector<SwitchChange> sequence(std::string_view text, double gap = 0.1) {
  Diagnostics diagnostics;
  auto plan = parse_switch_sequence(text, "s", gap, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  return plan;
}

TEST(SwitchSequence, ReadsChangesWaitsAndWhatIsAtOnce) {
  const auto sut = sequence("1+ 2+ 500ms 1-,2- 12+");
  ASSERT_EQ(sut.size(), 5U);
  EXPECT_EQ(sut[1].input, 2U);
  EXPECT_DOUBLE_EQ(sut[1].at_s, 0.1);
  EXPECT_DOUBLE_EQ(sut[2].at_s, 0.6);
  EXPECT_FALSE(sut[2].on);
  EXPECT_DOUBLE_EQ(sut[3].at_s, 0.6);
  EXPECT_EQ(sut[4].input, 12U);
  EXPECT_DOUBLE_EQ(end_of(sut), 0.7);
  EXPECT_TRUE(sequence("  \n ").empty());
}

TEST(SwitchSequence, RefusesWhatIsNone) {
  for (const char* bad :
       {"1", "+", "1*", "0+", "513+", "-1+", "+1+", "1+,", "1+,,2+", "1.5+", "0x", "5", "-1s", "1+ x"}) {
    Diagnostics diagnostics;
    static_cast<void>(parse_switch_sequence(bad, "s", 0.1, diagnostics));
    EXPECT_FALSE(diagnostics.ok()) << bad;
  }
  Diagnostics diagnostics;
  static_cast<void>(parse_switch_sequence("1+\n 2*", "s", 0.1, diagnostics));
  EXPECT_EQ(diagnostics.text().rfind("s:2:2: error: '2*'", 0), 0U) << diagnostics.text();
}

TEST(SwitchPlan, BouncesEndWhereTheChangeWanted) {
  const auto sut = with_bounces(sequence("3+ 3-"), 4, 0.003, 7);
  ASSERT_EQ(sut.size(), 2U * 9);
  EXPECT_TRUE(sut[8].on);
  EXPECT_FALSE(sut.back().on);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_LE(sut[i].at_s, 0.003);
    EXPECT_EQ(sut[i].bounce, i > 0);
    EXPECT_EQ(sut[i].on, i % 2 == 0);
  }
}

TEST(SwitchPlan, RandomPressesAreTheSeedsAndLeaveAllOpen) {
  const auto sut = random_presses(50, 8, 5, 3);
  const auto twin = random_presses(50, 8, 5, 3);
  ASSERT_EQ(sut.size(), twin.size());
  EXPECT_NEAR(static_cast<double>(sut.size()), 500, 60);
  std::vector<bool> closed(9, false);
  double before = 0;
  for (std::size_t i = 0; i < sut.size(); ++i) {
    EXPECT_EQ(sut[i].at_s, twin[i].at_s);
    EXPECT_GE(sut[i].at_s, before);
    EXPECT_LE(sut[i].at_s, 5.0);
    EXPECT_NE(closed[sut[i].input], sut[i].on) << "each change is one";
    closed[sut[i].input] = sut[i].on;
    before = sut[i].at_s;
  }
  EXPECT_EQ(std::count(closed.begin(), closed.end(), true), 0);
}

TEST(SwitchBits, LeaveOtherBitsAlone) {
  std::array<std::byte, 2> memory{std::byte{0b1010'0000}, std::byte{0xff}};
  const std::vector<SwitchChange> changes{
      {0, 1, true, false}, {0, 6, false, false}, {0, 16, false, false}, {0, 17, true, false}};
  EXPECT_EQ(put_switches(memory, changes), 1U);  // the third byte is not there
  EXPECT_EQ(memory[0], std::byte{0b1000'0001});
  EXPECT_EQ(memory[1], std::byte{0x7f});
}

TEST(Durations, NeedTheirUnit) {
  EXPECT_EQ(parse_duration("2s"), 2.0);
  EXPECT_EQ(parse_duration("250ms"), 0.25);
  for (const char* bad : {"2", "s", "ms", "-1s", "2 s", "1e7s", "nans", "2us"})
    EXPECT_FALSE(parse_duration(bad)) << bad;
}

TEST(HapticCommandLine, RefusesWithExitCodeTwo) {
  const auto parse = [](std::vector<const char*> words) {
    words.insert(words.begin(), "sim_haptic");
    return parse_haptic_command_line(static_cast<int>(words.size()), words.data());
  };
  EXPECT_EQ(parse({}).exit_code, 2);
  EXPECT_EQ(parse({"--key", "x"}).exit_code, 2);
  EXPECT_EQ(parse({"--key", "1", "--axes", "3"}).exit_code, 2);
  EXPECT_EQ(parse({"--key", "1", "--start", "1,2,3,4,5,6,7"}).exit_code, 2);
  EXPECT_EQ(parse({"--key", "1", "--for", "x"}).exit_code, 2);
  const auto sut =
      parse({"--key", "0x434F0001", "--axes", "5", "--start", "0,0,0.12", "--for", "0", "--fault", "nan@1"});
  ASSERT_FALSE(sut.exit_code);
  EXPECT_EQ(sut.options.key, 0x434F0001);
  EXPECT_EQ(sut.options.axes, 5U);
  EXPECT_EQ(sut.options.start[2], 0.12);
  EXPECT_EQ(sut.options.for_s, 0);
  EXPECT_EQ(sut.options.faults.size(), 1U);
}

}  // namespace
}  // namespace cellmirror::sim
