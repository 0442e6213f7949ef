// The gateway's side of a connection: the order of requests, samples, and every fault of a controller.
#include "drivers/rtde/rtde_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace cellmirror::rtde {
namespace {

constexpr std::uint8_t kRecipe = 4;

struct Recorder final : SessionOutput {
  void send(std::span<const std::uint8_t> bytes) override { sent.emplace_back(bytes.begin(), bytes.end()); }
  void sample(const JointSample& one) override { samples.push_back(one); }
  void data(std::span<const std::uint8_t> payload, Timestamp now) override {
    payloads.emplace_back(payload.begin(), payload.end());
    payload_times.push_back(now);
  }
  void rejected(const std::string& why) override { reasons.push_back(why); }
  void message(const std::string& text) override { messages.push_back(text); }

  std::vector<Bytes> sent;
  std::vector<JointSample> samples;
  std::vector<Bytes> payloads;
  std::vector<Timestamp> payload_times;
  std::vector<std::string> reasons;
  std::vector<std::string> messages;
};

RtdeStreamConfig six_joints() {
  RtdeStreamConfig config;
  for (std::size_t i = 0; i < kJoints; ++i) config.joints.push_back({.joint = i, .number = i});
  return config;
}

struct Link {
  explicit Link(const RtdeStreamConfig& config = six_joints()) : session(config, out) { session.begin(at(0)); }

  static Timestamp at(double s) { return Timestamp{std::isfinite(s) ? static_cast<std::int64_t>(s * 1e9) + 1 : 1}; }
  void receive(const Bytes& bytes, double s = 0) { session.receive(bytes, at(s)); }
  void run() {
    receive(accepted(PackageType::version, true));
    receive(outputs_answer({.recipe = kRecipe, .types = std::string(kAllVariableTypes)}));
    receive(accepted(PackageType::start, true));
  }
  void data(double timestamp_s, double q0 = 0) {
    RobotData robot{.timestamp_s = timestamp_s};
    robot.q[0] = q0;
    robot.q[5] = 0.6;
    robot.qd[5] = -0.1;
    receive(data_package(robot, kRecipe), timestamp_s);
  }

  Recorder out;
  RtdeSession session;
};

TEST(RtdeSession, AsksForVersionOutputsAndStartInTurn) {
  Link link;
  ASSERT_EQ(link.out.sent.size(), 1U);
  EXPECT_EQ(link.out.sent[0], version_request(2));
  link.receive(accepted(PackageType::version, true));
  ASSERT_EQ(link.out.sent.size(), 2U);
  EXPECT_EQ(link.out.sent[1], outputs_request(125, kAllVariables));
  link.receive(outputs_answer({.recipe = kRecipe, .types = std::string(kAllVariableTypes)}));
  ASSERT_EQ(link.out.sent.size(), 3U);
  EXPECT_EQ(link.out.sent[2], start_request());
  EXPECT_EQ(link.session.phase(), RtdeSession::Phase::starting);
  link.receive(accepted(PackageType::start, true));
  EXPECT_EQ(link.session.phase(), RtdeSession::Phase::running);
}

TEST(RtdeSession, SamplesHaveScaleAndOffsetAndTheJointsThatAreNamed) {
  RtdeStreamConfig config;
  config.joints.push_back({.joint = 2, .number = 5, .scale = -2, .offset = 0.5});
  Link link(config);
  link.run();
  link.data(1.0);
  ASSERT_EQ(link.out.samples.size(), 1U);
  const JointSample& sample = link.out.samples[0];
  EXPECT_EQ(sample.present, 0b100U);
  EXPECT_DOUBLE_EQ(sample.position[2], 0.5 - 1.2);
  EXPECT_DOUBLE_EQ(sample.velocity[2], 0.2);
  EXPECT_EQ(sample.receive_time, Link::at(1.0));
}

TEST(RtdeSession, DataPackagesAreGivenAsTheyCameEvenThoseThatAreRejected) {
  Link link;
  link.run();
  link.data(1.0, 0.25);
  Bytes other = data_package({.timestamp_s = 2.0}, kRecipe + 1);
  link.receive(other, 2.0);
  ASSERT_EQ(link.out.payloads.size(), 2U);
  EXPECT_EQ(link.out.samples.size(), 1U);
  constexpr std::ptrdiff_t kHead = 3;  // size and type
  EXPECT_EQ(link.out.payloads[1], Bytes(other.begin() + kHead, other.end()));
  EXPECT_EQ(link.out.payload_times[1], Link::at(2.0));
  EXPECT_EQ(decode_data(link.out.payloads[0], kRecipe)->q[0], 0.25);
}

TEST(RtdeSession, GapsInTheControllersTimeAreLostSamples) {
  Link link;
  link.run();
  link.data(1.000);
  link.data(1.008);
  link.data(1.032);
  EXPECT_EQ(link.session.counters().samples, 3U);
  EXPECT_EQ(link.session.counters().lost, 2U);
}

TEST(RtdeSession, ValuesThatAreNotFiniteAreRefusedAndOthersStay) {
  Link link;
  link.run();
  link.data(1.0, std::numeric_limits<double>::quiet_NaN());
  ASSERT_EQ(link.out.samples.size(), 1U);
  EXPECT_EQ(link.out.samples[0].refused, 1U);
  EXPECT_EQ(link.out.samples[0].present, 0b111110U);
  EXPECT_EQ(link.session.counters().rejected, 1U);
  link.data(std::numeric_limits<double>::infinity());
  EXPECT_EQ(link.out.samples.size(), 1U);
}

TEST(RtdeSession, PackagesThatAreNotNewerAreRefused) {
  Link link;
  link.run();
  link.data(1.0);
  link.data(1.0);
  link.data(0.5);
  EXPECT_EQ(link.session.counters().samples, 1U);
  EXPECT_EQ(link.session.counters().rejected, 2U);
  link.session.begin(Link::at(2));  // the controller was started again: its time begins anew
  link.run();
  link.data(0.1);
  EXPECT_EQ(link.session.counters().samples, 2U);
}

TEST(RtdeSession, AnOlderControllerIsAskedForFewerVariables) {
  Link link;
  link.receive(accepted(PackageType::version, true));
  link.receive(outputs_answer({.recipe = 1, .types = std::string(kVariableTypes) + ",NOT_FOUND"}));
  ASSERT_EQ(link.out.sent.size(), 3U);
  EXPECT_EQ(link.out.sent[2], outputs_request(125, kVariables));
  link.receive(outputs_answer({.recipe = kRecipe, .types = std::string(kVariableTypes)}));
  link.receive(accepted(PackageType::start, true));
  link.data(1.0);
  ASSERT_EQ(link.out.samples.size(), 1U);
  EXPECT_EQ(link.out.samples[0].effort[5], 0.0) << "unknown";
  EXPECT_FALSE(link.session.speed_scaling());
}

TEST(RtdeSession, OneStampFarAheadIsRefusedAndLaterOnesAreAccepted) {
  Link link;
  link.run();
  link.data(1.000);
  RobotData glitch{.timestamp_s = 1e9};
  link.receive(data_package(glitch, kRecipe), 1.008);
  EXPECT_NE(link.out.reasons.back().find("ahead"), std::string::npos);
  for (int i = 2; i < 100; ++i) link.data(1.0 + 0.008 * i);
  EXPECT_EQ(link.session.counters().samples, 99U);
  EXPECT_EQ(link.session.counters().rejected, 1U);
}

TEST(RtdeSession, ARestartedTimeIsAcceptedAfterThreePackages) {
  for (const double begin : {0.0, 1e6}) {
    Link link;
    link.run();
    link.data(100.0);
    for (int i = 1; i <= 10; ++i) {
      RobotData robot{.timestamp_s = begin + 0.008 * i};
      link.receive(data_package(robot, kRecipe), 100.0 + 0.008 * i);
    }
    EXPECT_EQ(link.session.counters().samples, 1U + 8U) << begin;
    EXPECT_EQ(link.session.counters().rejected, 2U) << begin;
    EXPECT_EQ(link.session.counters().lost, 0U) << "the time has changed; nothing is lost";
    EXPECT_EQ(link.out.messages.size(), 1U);
  }
}

TEST(RtdeSession, ALongPauseOfTheControllerIsNotARestartedTime) {
  Link link;
  link.run();
  link.data(1.0);
  link.data(61.0);
  EXPECT_EQ(link.session.counters().samples, 2U);
  EXPECT_GT(link.session.counters().lost, 7000U);
}

TEST(RtdeSession, EffortSpeedAndProgramComeWithTheJoints) {
  RtdeStreamConfig config;
  config.joints.push_back({.joint = 0, .number = 0, .scale = -1});
  config.joints.push_back({.joint = 1, .number = 1, .torque_nm_per_a = 12.5});
  Link link(config);
  link.run();
  RobotData robot{.timestamp_s = 1.0};
  robot.has_all = true;
  robot.moment = {30, 31, 32, 33, 34, 35};
  robot.current = {1, 2, 3, 4, 5, 6};
  robot.speed_scaling = 0.5;
  robot.runtime_state = 2;
  link.receive(data_package(robot, kRecipe), 1.0);
  ASSERT_EQ(link.out.samples.size(), 1U);
  EXPECT_EQ(link.out.samples[0].effort[0], -30.0) << "target moment of the controller, in the joint's direction";
  EXPECT_EQ(link.out.samples[0].effort[1], 25.0) << "measured current times torque constant";
  EXPECT_EQ(link.session.speed_scaling(), 0.5);
  EXPECT_EQ(runtime_state_text(*link.session.runtime_state()), "playing");
}

TEST(RtdeSession, KeepsTheReasonOfTheNewestRefusedPackage) {
  Link link;
  link.run();
  link.data(1.0);
  EXPECT_FALSE(link.session.last_refused().known());
  link.receive(data_package({.timestamp_s = 1.008}, kRecipe + 1), 1.008);
  EXPECT_EQ(link.session.last_refused(), Link::at(1.008));
  EXPECT_EQ(link.session.why_refused(), "a data package of another length or recipe");
  link.data(1.016);
  EXPECT_FALSE(link.session.last_refused().known()) << "the newest one was good";
}

TEST(RtdeSession, BytesDividedInTheWrongPlacesEndTheSession) {
  Link link;
  link.run();
  for (int i = 0; i < 100 && !link.session.failed(); ++i) link.receive({0, 5, 99, 1, 2});
  EXPECT_TRUE(link.session.failed());
  Link length;
  length.run();
  length.receive({0xFF, 0xFF, 85, 4});
  EXPECT_TRUE(length.session.failed()) << "no package is that long";
}

TEST(RtdeSession, WhatAControllerRefusesEndsTheConnectionWithTheReason) {
  Link version;
  version.receive(accepted(PackageType::version, false));
  EXPECT_TRUE(version.session.failed());
  EXPECT_NE(version.out.reasons.back().find("version"), std::string::npos);
  Link variables;
  variables.receive(accepted(PackageType::version, true));
  variables.receive(outputs_answer({.recipe = 0, .types = "DOUBLE,NOT_FOUND"}));
  EXPECT_FALSE(variables.session.failed()) << "an older controller is asked for fewer variables";
  variables.receive(outputs_answer({.recipe = 0, .types = "DOUBLE,NOT_FOUND"}));
  EXPECT_TRUE(variables.session.failed());
  EXPECT_NE(variables.out.reasons.back().find("NOT_FOUND"), std::string::npos);
}

TEST(RtdeSession, AnswersOutOfTurnAndForeignPackagesAreCountedOnly) {
  Link link;
  link.receive(accepted(PackageType::start, true));
  link.data(1.0);
  link.receive({0, 5, 73, 1, 2});
  EXPECT_EQ(link.session.counters().rejected, 3U);
  EXPECT_FALSE(link.session.failed());
  link.run();
  link.data(1.0);
  EXPECT_EQ(link.out.samples.size(), 1U);
  link.receive({0, 8, 77, 2, 'h', 'i', 0, 0});
  ASSERT_EQ(link.out.messages.size(), 1U);
  EXPECT_EQ(link.out.messages[0], "hi");
}

TEST(RtdeSession, BytesOfAnotherProtocolEndTheConnection) {
  Link link;
  link.receive({0, 0, 0, 0});
  EXPECT_TRUE(link.session.failed());
}

}  // namespace
}  // namespace cellmirror::rtde
