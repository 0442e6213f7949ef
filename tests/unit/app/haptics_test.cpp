// Haptic devices and the force at the TCP, as other programs and people see them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "app/io/haptic_stream.hpp"
#include "app/owner/tcp_force_service.hpp"
#include "app/report/status_haptics.hpp"
#include "app/snapshot/haptic_names.hpp"
#include "app/subcommands/status_table_haptics.hpp"
#include "app/workers/tcp_force_worker.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::app {
namespace {

constexpr std::uint8_t kSlot = 4;
constexpr std::uint8_t kChannel = 1;

struct Haptics : testing::Test {
  Haptics() {
    RobotSnapshot robot;
    robot.id = "LAP";
    robot.slot = kSlot;
    cell_state.robots.push_back(robot);
    cell_state.active_robot = "LAP";
    HapticSnapshot haptic;
    haptic.robot = "LAP";
    haptic.slot = kSlot;
    haptic.channel = kChannel;
    haptic.online = true;
    haptic.key = 4711;
    haptic.bytes = 512;
    haptic.meter = std::make_shared<HapticMeter>();
    cell_state.haptics.push_back(haptic);
    tick.time = Timestamp{2'000'000'000};
    HapticState& state = tick.haptics[kChannel];
    state.phase = HapticPhase::active;
    state.slot = kSlot;
    state.force_E = {1, 2, -2};
    state.force_W = {0, 3, 0};
    state.axis_torque = 0.25;
    state.device_time = Timestamp{1'999'000'000};
  }

  CellState cell_state;
  engine::TickState tick{8};
  ContactReport contacts;
};

TEST_F(Haptics, ForceAtTheTcpIsThatOfTheActiveRobotsDevice) {
  const TcpForce sut = tcp_force_of(cell_state, tick);
  EXPECT_EQ(sut.values, (std::array<float, 4>{1, 2, -2, 0.25F}));
  EXPECT_EQ(sut.flags, kTcpForceValid);
  EXPECT_EQ(sut.robot.view(), "LAP");
  EXPECT_EQ(sut.time, tick.time);
}

TEST_F(Haptics, RateOfSamplesIsThatOfTheTickWhileTheDeviceIsOpen) {
  const auto meter = std::make_shared<HapticMeter>();
  meter->samples_per_second = 998;
  HapticStream sut([] { return Result<void>(); }, [] {});
  sut.set_memory("shared memory", meter);
  EXPECT_EQ(sut.status().rate_hz, 0.0);
  struct Ignored final : JointSampleSink {
    bool push(const JointSample& /*sample*/) noexcept override { return true; }
  };
  Ignored sink;
  ASSERT_TRUE(sut.open(sink));
  EXPECT_EQ(sut.status().rate_hz, 998.0);
  sut.close();
  EXPECT_EQ(sut.status().rate_hz, 0.0);
}

TEST_F(Haptics, NothingIsKnownOfOtherRobotsAndClosedDevices) {
  tick.haptics[kChannel].slot = kSlot + 1;
  EXPECT_EQ(tcp_force_of(cell_state, tick).flags, 0U);
  EXPECT_EQ(tcp_force_of(cell_state, tick).values, (std::array<float, 4>{}));
  tick.haptics[kChannel].slot = kSlot;
  tick.haptics[kChannel].phase = HapticPhase::closed;
  EXPECT_EQ(tcp_force_of(cell_state, tick).flags, 0U);
  cell_state.active_robot.clear();
  EXPECT_EQ(tcp_force_of(cell_state, tick).robot.view(), "");
}

TEST_F(Haptics, ForceAtTheTcpIsThatOfTissueWhereNoDeviceMovesTheRobot) {
  InstrumentLoads loads{.posture_time = tick.time, .loads = {}};
  loads.loads.push_back(
      {.slot = kSlot, .force_T = Eigen::Vector3d(0, 0, -4.7), .torque_T = Eigen::Vector3d(1, 1, 0.1)});
  EXPECT_EQ(tcp_force_of(cell_state, tick, &loads).values[0], 1.0F) << "of the device";
  tick.haptics[kChannel].phase = HapticPhase::closed;
  cell_state.forces.limits = {1, 0};  // SET_TORQUE_LIMIT 1 0
  const TcpForce sut = tcp_force_of(cell_state, tick, &loads);
  EXPECT_EQ(sut.values, (std::array<float, 4>{0, 0, -4.7F, 0.1F}));
  EXPECT_EQ(sut.flags, kTcpForceValid | kTcpForceBeyondLimit);
  cell_state.haptics.clear();
  EXPECT_EQ(tcp_force_of(cell_state, tick, &loads).values, sut.values) << "a cell without devices";
  tick.time = tick.time + Nanoseconds(300'000'000);
  EXPECT_EQ(tcp_force_of(cell_state, tick, &loads).flags, 0U) << "the simulation has stalled";
}

TEST_F(Haptics, LimitsCountOnlyWhereTheyAreSet) {
  cell_state.forces.limits = {2.9, 0};  // the force is 3 N
  EXPECT_NE(tcp_force_of(cell_state, tick).flags & kTcpForceBeyondLimit, 0U);
  cell_state.forces.limits = {3.1, 0};
  EXPECT_EQ(tcp_force_of(cell_state, tick).flags & kTcpForceBeyondLimit, 0U);
  cell_state.forces.limits = {0, 0.2};
  EXPECT_NE(tcp_force_of(cell_state, tick).flags & kTcpForceBeyondLimit, 0U);
}

TEST_F(Haptics, TestValuesTakeThePlaceOfTheTruth) {
  cell_state.forces.test = std::array<double, 4>{9, 0, 0, -1};
  cell_state.forces.limits = {5, 0};
  const TcpForce sut = tcp_force_of(cell_state, tick);
  EXPECT_EQ(sut.values, (std::array<float, 4>{9, 0, 0, -1}));
  EXPECT_EQ(sut.flags, kTcpForceValid | kTcpForceTest | kTcpForceBeyondLimit);
}

TEST_F(Haptics, StatusReportsTheForceOfTissueAndItsAge) {
  HapticState& state = tick.haptics[kChannel];
  state.tissue_force_W = {0, 1.5, 0};
  state.tissue_time = Timestamp{1'998'000'000};
  state.tissue_contacts = 7;
  state.tissue_held = 2;
  state.tissue_late = 3;
  state.tissue_refused = 1;
  const nlohmann::json device = haptics_json(cell_state, tick, contacts, tick.time).at("devices").at(0);
  EXPECT_EQ(device.at("tissue_force_n"), nlohmann::json({0.0, 1.5, 0.0}));
  EXPECT_NEAR(device.at("tissue_age_s").get<double>(), 0.002, 1e-12);
  EXPECT_EQ(device.at("tissue"), nlohmann::json({{"contacts", 7}, {"held", 2}, {"late", 3}, {"refused", 1}}));
}

TEST(TorqueLimit, MessageTellsTheForceThatWasBeyondItAndNotALaterOne) {
  ManualClock clock;
  std::string told;
  TcpForceService sut({.key = 0x43510000 + static_cast<std::int32_t>(getpid() & 0xFFFF),
                       .instance = "force-desk-test",
                       .clock = clock,
                       .show_message = [&](std::string_view text) { told = text; }});
  const auto set = sut.set_limits({5, 0});
  ASSERT_TRUE(set) << set.error().text();
  TcpForce force;
  force.robot.assign("LAP");
  force.values = {0, 0, 7.25F, 0};
  force.flags = kTcpForceValid | kTcpForceBeyondLimit;
  sut.memory()->write(force);
  force.values = {0, 0, 1.5F, 0};
  force.flags = kTcpForceValid;
  sut.memory()->write(force);
  sut.follow();
  EXPECT_NE(told.find("7.25 N"), std::string::npos) << told;
}

TEST_F(Haptics, StatusTellsPhaseAgeAndForce) {
  const nlohmann::json sut = haptics_json(cell_state, tick, contacts, tick.time);
  const nlohmann::json& device = sut.at("devices").at(0);
  EXPECT_EQ(device.at("phase"), "active");
  EXPECT_EQ(device.at("fault"), "none");
  EXPECT_NEAR(device.at("device").at("age_s").get<double>(), 0.001, 1e-12);
  EXPECT_EQ(device.at("force").at("world_n").at(1), 3.0);
  EXPECT_EQ(device.at("memory").at("key"), 4711);
  EXPECT_TRUE(device.at("tissue_age_s").is_null()) << "there is no tissue";
  EXPECT_TRUE(sut.at("tcp_force").is_null());
}

TEST_F(Haptics, TableTellsAFaultAndWhatToDo) {
  tick.haptics[kChannel].phase = HapticPhase::faulted;
  tick.haptics[kChannel].fault = HapticFault::two_writers;
  tick.haptics[kChannel].awaited = HapticAwaited::reset;
  const std::string sut = haptics_table({{"haptics", haptics_json(cell_state, tick, contacts, tick.time)}});
  EXPECT_NE(sut.find("FAULT two_writers"), std::string::npos) << sut;
  EXPECT_NE(sut.find("end one of the two processes; then RESET_HAPTIC LAP"), std::string::npos) << sut;
  EXPECT_EQ(haptics_table(nlohmann::json::object()), "");
}

TEST_F(Haptics, TableTellsWhatAFaultThatPassesByItselfWaitsFor) {
  tick.haptics[kChannel].phase = HapticPhase::faulted;
  tick.haptics[kChannel].fault = HapticFault::stale;
  tick.haptics[kChannel].awaited = HapticAwaited::rest;
  const nlohmann::json status = haptics_json(cell_state, tick, contacts, tick.time);
  EXPECT_EQ(status.at("devices").at(0).at("awaits"), "rest");
  const std::string sut = haptics_table({{"haptics", status}});
  EXPECT_NE(sut.find("engages again by itself, waits for the hand at rest"), std::string::npos) << sut;
  EXPECT_EQ(sut.find("RESET_HAPTIC"), std::string::npos) << sut;
}

TEST(HapticFaultText, NamesTheRemedyOfWhatStaysAndWhatTheOthersWaitFor) {
  HapticState state;
  EXPECT_EQ(fault_text(state, "LAP"), "");
  state.fault = HapticFault::jump;
  state.awaited = HapticAwaited::reset;
  EXPECT_NE(fault_text(state, "LAP").find("; then RESET_HAPTIC LAP"), std::string::npos) << fault_text(state, "LAP");
  state.fault = HapticFault::vanished;
  state.awaited = HapticAwaited::outside;
  EXPECT_NE(fault_text(state, "LAP").find("waits for the hand outside of bodies"), std::string::npos);
}

TEST_F(Haptics, TableTellsThatTheSurroundingsAreAwaited) {
  const auto table = [this] {
    return haptics_table({{"haptics", haptics_json(cell_state, tick, contacts, tick.time)}});
  };
  EXPECT_EQ(table().find("waits for the surroundings"), std::string::npos);
  tick.haptics[kChannel].phase = HapticPhase::waiting;
  tick.haptics[kChannel].awaits_surroundings = true;
  EXPECT_NE(table().find("waits for the surroundings"), std::string::npos);
}

TEST_F(Haptics, DeviceWithoutMemoryIsShownAsSuch) {
  cell_state.haptics.front().key.reset();
  cell_state.haptics.front().online = false;
  const nlohmann::json sut = haptics_json(cell_state, tick, contacts, tick.time);
  EXPECT_TRUE(sut.at("devices").at(0).at("memory").is_null());
  EXPECT_NE(haptics_table({{"haptics", sut}}).find("offline  no shared memory"), std::string::npos);
}

TEST(HapticWords, EveryFaultHasAWordAnExplanationAndARemedy) {
  std::set<std::string> words;
  for (int i = 1; i <= static_cast<int>(HapticFault::not_passive); ++i) {
    const auto fault = static_cast<HapticFault>(i);
    EXPECT_TRUE(words.emplace(word(fault)).second) << i;
    EXPECT_NE(std::string(explanation(fault)), "") << i;
    EXPECT_NE(std::string(remedy(fault)), "") << i;
  }
  for (int i = 0; i <= static_cast<int>(HapticPhase::faulted); ++i)
    EXPECT_TRUE(words.emplace(word(static_cast<HapticPhase>(i))).second) << i;
}

}  // namespace
}  // namespace cellmirror::app
