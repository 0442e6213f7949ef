// Streams fed by Cyclone DDS.
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <regex>
#include <string>

#include "cyclone_peer.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/joint_state_publisher.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

constexpr char kTopic[] = "rt/joint_states";

DdsStreamConfig config(int domain, std::vector<std::string> names) {
  DdsStreamConfig made;
  made.domain = domain;
  made.topic = kTopic;
  for (std::size_t i = 0; i < names.size(); ++i) made.joints.push_back({names[i], i, 1.0, 0.0});
  return made;
}

class DdsStreamTest : public testing::Test {
 protected:
  std::unique_ptr<JointStream> stream(const DdsStreamConfig& from, JointSampleSink& sink) {
    auto made = make_dds_stream(from, clock_);
    EXPECT_TRUE(made.has_value()) << made.error().text();
    const auto opened = (*made)->open(sink);
    EXPECT_TRUE(opened.has_value()) << opened.error().text();
    return std::move(*made);
  }

  int domain_ = test_domain(0);
  SystemClock clock_;
};

TEST_F(DdsStreamTest, ReceivesWhatCycloneDdsPublishes) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  CollectingSink sink;
  const auto sut = stream(config(domain_, {"shoulder", "elbow"}), sink);
  ASSERT_TRUE(eventually([&] { return CyclonePeer::matched_readers(writer) == 1; }));

  const std::int64_t wall_ns = to_wall_clock_ns(clock_.now());
  PlainJointState message{.sec = static_cast<std::int32_t>(wall_ns / 1'000'000'000),
                          .nanosec = static_cast<std::uint32_t>(wall_ns % 1'000'000'000),
                          .frame_id = "base",
                          .name = {"elbow", "somebody else's", "shoulder"},
                          .position = {0.5, 9.0, -1.25},
                          .velocity = {0.1, 9.0, 0.2},
                          .effort = {}};
  ASSERT_TRUE(eventually([&] {
    CyclonePeer::write(writer, message);
    return sink.size() > 0;
  }));

  const JointSample sample = sink.samples().front();
  EXPECT_EQ(sample.present, 0b11U);
  EXPECT_EQ(sample.refused, 0U);
  EXPECT_EQ(sample.position[0], -1.25);
  EXPECT_EQ(sample.position[1], 0.5);
  EXPECT_EQ(sample.velocity[0], 0.2);
  EXPECT_EQ(sample.effort[0], 0.0);
  EXPECT_GE(sample.receive_time, sample.source_time);
  EXPECT_LT(seconds(sample.receive_time - sample.source_time), 25.0);
  const JointStreamStatus status = sut->status();
  EXPECT_EQ(status.kind, "dds");
  EXPECT_TRUE(status.open);
  EXPECT_GE(status.received, 1U);
  EXPECT_TRUE(status.condition.starts_with("1 publisher")) << status.condition;
}

TEST_F(DdsStreamTest, WorksWithBestEffortAndReliableOnBothSides) {
  for (const bool peer_reliable : {false, true}) {
    for (const bool ours_reliable : {false, true}) {
      CyclonePeer peer(domain_);
      const dds_entity_t writer = peer.joint_state_writer(kTopic, peer_reliable);
      CollectingSink sink;
      DdsStreamConfig asked = config(domain_, {"a"});
      asked.reliable = ours_reliable;
      const auto sut = stream(asked, sink);
      if (ours_reliable && !peer_reliable) {
        EXPECT_TRUE(eventually([&] { return sut->status().condition.find("best effort") != std::string::npos; }))
            << sut->status().condition;
        continue;
      }
      const PlainJointState message{.name = {"a"}, .position = {1.0}};
      EXPECT_TRUE(eventually([&] {
        CyclonePeer::write(writer, message);
        return sink.size() > 0;
      })) << peer_reliable
          << ours_reliable;
    }
  }
}

TEST_F(DdsStreamTest, SeveralRobotsShareATopicEachTakingItsOwn) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  CollectingSink left_sink;
  CollectingSink right_sink;
  const auto left = stream(config(domain_, {"left_1", "left_2"}), left_sink);
  const auto right = stream(config(domain_, {"right_1"}), right_sink);
  ASSERT_TRUE(eventually([&] { return CyclonePeer::matched_readers(writer) >= 1; }));
  EXPECT_EQ(CyclonePeer::matched_readers(writer), 1) << "streams of one topic share a reader";

  ASSERT_TRUE(eventually([&] {
    CyclonePeer::write(writer, {.name = {"left_2", "right_1"}, .position = {2.0, 3.0}});
    return left_sink.size() > 0 && right_sink.size() > 0;
  }));
  EXPECT_EQ(left_sink.samples().front().present, 0b10U);
  EXPECT_EQ(left_sink.samples().front().position[1], 2.0);
  EXPECT_EQ(right_sink.samples().front().present, 0b1U);
  EXPECT_EQ(right_sink.samples().front().position[0], 3.0);
}

TEST_F(DdsStreamTest, TellsOfImplausibleTimeStamps) {
  CollectingSink sink;
  const auto sut = stream(config(domain_, {"a"}), sink);
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  const auto becomes = [&](Nanoseconds age, const std::string& condition) {
    return eventually([&] {
      const RosTime stamp = ros_time(to_wall_clock_ns(clock_.now()) - age.count());
      CyclonePeer::write(writer, {.sec = stamp.sec, .nanosec = stamp.nanosec, .name = {"a"}, .position = {1.0}});
      return std::regex_match(sut->status().condition, std::regex(condition));
    });
  };
  constexpr Nanoseconds kHalfASecond(500'000'000);
  EXPECT_TRUE(becomes({}, "1 publisher")) << sut->status().condition;
  EXPECT_TRUE(becomes(kHalfASecond, "1 publisher, whose time stamps are 0.5\\d s old on arrival: .*"))
      << sut->status().condition;
  EXPECT_TRUE(becomes(-kHalfASecond, "1 publisher, whose time stamps are 0.[45]\\d s in the future: .*"))
      << sut->status().condition;
  EXPECT_EQ(sut->status().rejected, 0U) << "values are taken all the same";
}

TEST_F(DdsStreamTest, TellsWhyNothingComes) {
  CollectingSink sink;
  const auto sut = stream(config(domain_, {"a"}), sink);
  EXPECT_EQ(sut->status().condition, "no publisher on rt/joint_states in domain " + std::to_string(domain_));
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  EXPECT_TRUE(eventually([&] { return sut->status().condition == "1 publisher, nothing received yet"; }));
  EXPECT_TRUE(eventually([&] {
    CyclonePeer::write(writer, {.name = {"b"}, .position = {1.0}});
    return sut->status().condition == "1 publisher, no message names a joint of this robot";
  }));
  EXPECT_EQ(sut->status().rejected, 0U);
  sut->close();
  EXPECT_EQ(sut->status().condition, "closed");
}

TEST_F(DdsStreamTest, RefusesAndCountsBadValues) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  CollectingSink sink;
  DdsStreamConfig asked = config(domain_, {"a", "b"});
  asked.reliable = true;
  const auto sut = stream(asked, sink);
  ASSERT_TRUE(
      eventually([&] { return CyclonePeer::matched_readers(writer) == 1 && sut->status().condition[0] == '1'; }));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CyclonePeer::write(writer, {.name = {"a", "b"}, .position = {nan, 4.0}});
  CyclonePeer::write(writer, {.name = {"a", "b"}, .position = {1.0}});
  CyclonePeer::write(writer, {.name = {"a", "b"}, .position = {5.0, 6.0}});
  ASSERT_TRUE(eventually([&] { return sink.size() == 2; }));
  EXPECT_EQ(sink.samples()[0].refused, 0b01U);
  EXPECT_EQ(sink.samples()[0].present, 0b10U);
  EXPECT_EQ(sink.samples()[1].present, 0b11U);
  EXPECT_EQ(sut->status().rejected, 2U);
  EXPECT_EQ(sut->status().last_errors.size(), 2U);
}

TEST_F(DdsStreamTest, SurvivesBytesThatAreNoJointState) {
  auto publisher = JointStatePublisher::make({.domain = domain_, .topic = kTopic});
  ASSERT_TRUE(publisher.has_value()) << publisher.error().text();
  CollectingSink sink;
  const auto sut = stream(config(domain_, {"a"}), sink);
  ASSERT_TRUE(eventually([&] { return (*publisher)->matched_readers() == 1; }));
  const std::vector<std::vector<std::byte>> bad = {
      {},
      {std::byte{0}},
      std::vector<std::byte>(4, std::byte{0xff}),
      std::vector<std::byte>(60'000, std::byte{0xff}),
      std::vector<std::byte>(3U << 20U, std::byte{0xff}),
      {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}, std::byte{1}},
  };
  for (const auto& bytes : bad) (*publisher)->publish_bytes(bytes);
  EXPECT_TRUE(eventually([&] {
    (*publisher)->publish({.header = {}, .name = {"a"}, .position = {1.0}, .velocity = {}, .effort = {}});
    return sink.size() > 0;
  }));
  EXPECT_GE(sut->status().rejected, 3U);
}

TEST_F(DdsStreamTest, CanBeClosedAndOpenedAgain) {
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  CollectingSink sink;
  const auto sut = stream(config(domain_, {"a"}), sink);
  for (int round = 0; round < 3; ++round) {
    const std::size_t before = sink.size();
    EXPECT_TRUE(eventually([&] {
      CyclonePeer::write(writer, {.name = {"a"}, .position = {1.0}});
      return sink.size() > before;
    })) << round;
    sut->close();
    const std::size_t at_close = sink.size();
    CyclonePeer::write(writer, {.name = {"a"}, .position = {1.0}});
    EXPECT_EQ(sink.size(), at_close);
    ASSERT_TRUE(sut->open(sink).has_value());
  }
}

TEST_F(DdsStreamTest, RefusesWhatCannotWork) {
  CollectingSink sink;
  DdsStreamConfig wrong = config(domain_, {"a"});
  wrong.domain = 233;
  EXPECT_FALSE(make_dds_stream(wrong, clock_).has_value());
  wrong = config(domain_, {"a"});
  wrong.topic.clear();
  EXPECT_FALSE(make_dds_stream(wrong, clock_).has_value());
  EXPECT_FALSE(make_dds_stream(config(domain_, {}), clock_).has_value());
  wrong = config(domain_, {"a"});
  wrong.interface_address = "192.0.2.1";
  auto made = make_dds_stream(wrong, clock_);
  ASSERT_TRUE(made.has_value());
  const auto opened = (*made)->open(sink);
  ASSERT_FALSE(opened.has_value());
  EXPECT_NE(opened.error().text().find("192.0.2.1"), std::string::npos);
  EXPECT_NE(opened.error().text().find("127.0.0.1"), std::string::npos);
}

TEST_F(DdsStreamTest, WorksInTheHighestDomain) {
  CollectingSink sink;
  const auto sut = stream(config(232, {"a"}), sink);
  EXPECT_EQ(sut->status().condition, "no publisher on rt/joint_states in domain 232");
}

std::vector<std::string> moving_joints(const std::filesystem::path& urdf) {
  std::vector<std::string> names;
  tinyxml2::XMLDocument document;
  if (document.LoadFile(urdf.c_str()) != tinyxml2::XML_SUCCESS) return names;
  const tinyxml2::XMLElement* joint = document.FirstChildElement("robot")->FirstChildElement("joint");
  for (; joint != nullptr; joint = joint->NextSiblingElement("joint")) {
    if (!joint->Attribute("type", "fixed")) names.emplace_back(joint->Attribute("name"));
  }
  return names;
}

std::filesystem::path shared_data() {
  if (const char* set = std::getenv("CELLMIRROR_SHARED_DATA")) return set;
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return std::filesystem::path(source != nullptr ? source : ".") / ".." / "shared" / "data";
}

TEST_F(DdsStreamTest, MirrorsARealRobotsJointNames) {
  const std::filesystem::path urdf = shared_data() / "robots" / "panda" / "panda.urdf";
  if (!std::filesystem::exists(urdf)) GTEST_SKIP() << "skipped: no " << urdf;
  const std::vector<std::string> names = moving_joints(urdf);
  ASSERT_GE(names.size(), 7U);
  CyclonePeer peer(domain_);
  const dds_entity_t writer = peer.joint_state_writer(kTopic, true);
  CollectingSink sink;
  const auto sut = stream(config(domain_, names), sink);
  PlainJointState message;
  for (std::size_t i = names.size(); i-- > 0;) {  // in another order than the robot's
    message.name.push_back(names[i]);
    message.position.push_back(0.1 * static_cast<double>(i));
    message.velocity.push_back(0.01 * static_cast<double>(i));
    message.effort.push_back(static_cast<double>(i));
  }
  ASSERT_TRUE(eventually([&] {
    CyclonePeer::write(writer, message);
    return sink.size() > 0;
  }));
  const JointSample sample = sink.samples().front();
  EXPECT_EQ(sample.present, (1U << names.size()) - 1U);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(sample.position[i], 0.1 * static_cast<double>(i)) << names[i];
    EXPECT_EQ(sample.effort[i], static_cast<double>(i)) << names[i];
  }
}

}  // namespace
}  // namespace cellmirror::dds::test
