// The gateway's output as Cyclone DDS sees it.
#include "drivers/dds/dds_output.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <numbers>
#include <string>
#include <thread>

#include "child_process.hpp"
#include "cyclone_peer.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

RobotState robot(const std::string& id, const std::vector<std::pair<std::string, double>>& joints) {
  RobotState state;
  state.id = id;
  for (const auto& [name, position] : joints) {
    RobotJointState joint;
    joint.name = name;
    joint.position = position;
    joint.velocity = 10 * position;
    joint.effort = 100 * position;
    state.joints.push_back(joint);
  }
  return state;
}

class DdsOutputTest : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<RobotStateOutput> output() const {
    auto made = make_dds_output(config_);
    EXPECT_TRUE(made.has_value()) << made.error().text();
    return std::move(*made);
  }
  static std::uint64_t counter(const RobotStateOutput& output, const std::string& name) {
    for (const auto& [key, value] : output.counters()) {
      if (key == name) return value;
    }
    ADD_FAILURE() << "no counter " << name;
    return 0;
  }

  DdsOutputConfig config_{.enabled = true,
                          .domain = test_domain(1),
                          .interface_address = "127.0.0.1",
                          .joint_states_topic = "rt/cellmirror/joint_states",
                          .tf_topic = "rt/tf",
                          .rate_hz = 50};
  SystemClock clock_;
};

TEST_F(DdsOutputTest, CycloneDdsReadsJointStatesAndTransforms) {
  CyclonePeer peer(config_.domain);
  const dds_entity_t joints = peer.joint_state_reader(config_.joint_states_topic, true);
  const dds_entity_t tf = peer.tf_reader(config_.tf_topic);
  const auto sut = output();
  ASSERT_TRUE(eventually([&] {
    return counter(*sut, "joint_states_readers") == 1 && counter(*sut, "tf_readers") == 1 &&
           CyclonePeer::matched_writers(joints) == 1 && CyclonePeer::matched_writers(tf) == 1;
  }));

  const std::vector<RobotState> robots = {robot("A", {{"base", 0.25}, {"wrist", -1.5}}), robot("B", {{"base", 3.0}})};
  Pose X_PC = pose_from_xyz_rpy({1, 2, 3}, {0, 0, std::numbers::pi / 2});
  const std::vector<FramePose> frames = {{"world", "A.base", X_PC}};
  const Timestamp time = clock_.now();
  sut->publish(time, robots, frames);

  std::vector<PlainJointState> messages;
  std::vector<PlainTransform> transforms;
  ASSERT_TRUE(eventually([&] {
    for (auto& message : CyclonePeer::take_joint_states(joints)) messages.push_back(message);
    for (auto& transform : CyclonePeer::take_transforms(tf)) transforms.push_back(transform);
    return !messages.empty() && !transforms.empty();
  }));
  EXPECT_EQ(messages[0].name, (std::vector<std::string>{"A/base", "wrist", "B/base"}));
  EXPECT_EQ(messages[0].position, (std::vector<double>{0.25, -1.5, 3.0}));
  EXPECT_EQ(messages[0].velocity, (std::vector<double>{2.5, -15.0, 30.0}));
  EXPECT_EQ(messages[0].effort, (std::vector<double>{25.0, -150.0, 300.0}));
  const std::int64_t stamp_ns = std::int64_t{messages[0].sec} * 1'000'000'000 + messages[0].nanosec;
  EXPECT_NEAR(static_cast<double>(stamp_ns - to_wall_clock_ns(time)), 0.0, 1e6);
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].parent, "world");
  EXPECT_EQ(transforms[0].child, "A.base");
  EXPECT_EQ(transforms[0].translation[0], 1.0);
  EXPECT_EQ(transforms[0].translation[2], 3.0);
  EXPECT_NEAR(transforms[0].rotation[2], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(transforms[0].rotation[3], std::sqrt(0.5), 1e-15);
  EXPECT_EQ(counter(*sut, "sent"), 2U);
  EXPECT_EQ(counter(*sut, "dropped"), 0U);
}

// RViz comes when it likes and has to find the description that was published long before; a large one too.
TEST_F(DdsOutputTest, AReaderThatComesLaterGetsTheNewestDescription) {
  auto made = make_dds_output(config_);
  ASSERT_TRUE(made) << made.error().text();
  const auto& sut = *made;
  std::string large = "<robot name=\"r\">";
  while (large.size() < 300'000) large += "<link name=\"link_" + std::to_string(large.size()) + "\"/>";
  sut->publish_description("<robot name=\"old\"/>");
  sut->publish_description(large);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CyclonePeer peer(config_.domain);
  const dds_entity_t reader = peer.description_reader("rt/robot_description");
  std::vector<std::string> texts;
  const auto arrived = [&] {
    for (auto& text : CyclonePeer::take_texts(reader)) texts.push_back(std::move(text));
    return !texts.empty();
  };
  ASSERT_TRUE(eventually(arrived));
  ASSERT_EQ(texts.size(), 1U) << "the newest one alone";
  EXPECT_EQ(texts[0], large);
  texts.clear();
  sut->publish_description("<robot name=\"new\"/>");
  ASSERT_TRUE(eventually(arrived));
  EXPECT_EQ(texts[0], "<robot name=\"new\"/>");
  EXPECT_EQ(counter(*sut, "description_sent"), 3U);
}

TEST_F(DdsOutputTest, WithoutATopicThereIsNoDescription) {
  config_.robot_description_topic.clear();
  auto made = make_dds_output(config_);
  ASSERT_TRUE(made) << made.error().text();
  (*made)->publish_description("<robot name=\"r\"/>");
  for (const auto& [key, value] : (*made)->counters()) EXPECT_NE(key, "description_sent");
}

TEST_F(DdsOutputTest, ManyFramesGoInSeveralMessages) {
  CyclonePeer peer(config_.domain);
  const dds_entity_t tf = peer.tf_reader(config_.tf_topic);
  const auto sut = output();
  ASSERT_TRUE(eventually([&] { return counter(*sut, "tf_readers") == 1 && CyclonePeer::matched_writers(tf) == 1; }));
  std::vector<FramePose> frames;
  for (int i = 0; i < 1000; ++i) frames.push_back({"world", "frame_" + std::to_string(i), Pose::Identity()});
  sut->publish(clock_.now(), {}, frames);
  std::size_t received = 0;
  EXPECT_TRUE(eventually([&] {
    received += CyclonePeer::take_transforms(tf).size();
    return received >= frames.size();
  }));
  EXPECT_EQ(received, frames.size());
  EXPECT_EQ(counter(*sut, "tf_sent"), 4U);
  EXPECT_EQ(counter(*sut, "joint_states_sent"), 0U);
}

TEST_F(DdsOutputTest, AStoppedReliableReaderHoldsNobodyUp) {
  ChildProcess reader("dds_cyclone_peer", {"read", std::to_string(config_.domain), config_.joint_states_topic});
  const auto sut = output();
  const std::vector<RobotState> robots = {robot("A", {{"j", 1.0}})};
  ASSERT_TRUE(eventually([&] {
    sut->publish(clock_.now(), robots, {});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return reader.lines() > 60;
  }));
  const std::uint64_t dropped = counter(*sut, "dropped");
  EXPECT_LT(dropped, counter(*sut, "sent") / 2) << "this reader follows";

  reader.signal(SIGSTOP);
  std::vector<double> took_s;
  for (int i = 0; i < 500; ++i) {
    const Timestamp before = clock_.now();
    sut->publish(before, robots, {});
    took_s.push_back(seconds(clock_.now() - before));
  }
  std::ranges::nth_element(took_s, took_s.begin() + 450);  // the machine may stand still in some of them
  EXPECT_LT(took_s[450], 0.05) << "publish() waited";
  // The process of the DDS library counts them.
  EXPECT_TRUE(eventually([&] { return counter(*sut, "dropped") > dropped + 100; }));

  reader.signal(SIGCONT);
  const int before = reader.lines();
  EXPECT_TRUE(eventually([&] {
    sut->publish(clock_.now(), robots, {});
    return reader.lines() > before;
  })) << "the reader recovers";
}

TEST_F(DdsOutputTest, RefusesWhatCannotWork) {
  DdsOutputConfig wrong = config_;
  wrong.tf_topic = wrong.joint_states_topic;
  const auto same_topic = make_dds_output(wrong);
  ASSERT_FALSE(same_topic.has_value());
  EXPECT_NE(same_topic.error().text().find(wrong.joint_states_topic), std::string::npos);
  wrong = config_;
  wrong.rate_hz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(make_dds_output(wrong).has_value());
  wrong = config_;
  wrong.interface_address = "localhost";
  EXPECT_FALSE(make_dds_output(wrong).has_value());
}

}  // namespace
}  // namespace cellmirror::dds::test
