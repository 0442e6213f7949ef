// Peers that die, come back, or send what they like.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "child_process.hpp"
#include "cyclone_peer.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/joint_state_publisher.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

DdsStreamConfig one_joint(int domain, const std::string& topic, const std::string& name = "a") {
  DdsStreamConfig made;
  made.domain = domain;
  made.topic = topic;
  made.joints = {{name, 0, 1.0, 0.0}};
  made.ages.lost_after = Nanoseconds(200'000'000);
  return made;
}

TEST(DdsRecovery, AKilledPublisherComesBackWithoutARestart) {
  const int domain = test_domain(2);
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain, "rt/joint_states"), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  for (int life = 0; life < 3; ++life) {
    const std::size_t before = sink.size();
    ChildProcess publisher("dds_cyclone_peer", {"write", std::to_string(domain), "rt/joint_states", "2"});
    ASSERT_TRUE(eventually([&] { return sink.size() > before + 20; })) << "life " << life;
    publisher.kill_and_wait();
    EXPECT_TRUE(eventually([&] { return sut->status().condition.find("silent for") != std::string::npos; }))
        << sut->status().condition;
  }
  EXPECT_EQ(sut->status().rejected, 0U);
  EXPECT_EQ(sut->status().lost, 0U) << "a new life of a publisher is no gap";
}

TEST(DdsRecovery, APeerThatSendsNoiseUnderTheRightTypeNameDisturbsNobody) {
  const int domain = test_domain(3);
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain, "rt/joint_states"), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  ChildProcess noise("dds_garbage_peer", {std::to_string(domain), "rt/joint_states", "7"});
  ASSERT_TRUE(eventually([&] { return sut->status().rejected > 200; })) << sut->status().condition;
  ChildProcess publisher("dds_cyclone_peer", {"write", std::to_string(domain), "rt/joint_states", "2"});
  EXPECT_TRUE(eventually([&] { return sink.size() > 50; }));
  EXPECT_EQ(sink.samples().back().present, 1U);
  EXPECT_FALSE(sut->status().last_errors.empty());
}

TEST(DdsRecovery, WhatWasSentWhileAStreamWasClosedIsNotLost) {
  const int domain = test_domain(4);
  SystemClock clock;
  CollectingSink sink;
  auto publisher = JointStatePublisher::make({.domain = domain, .topic = "rt/gaps", .reliable = false}).value();
  const auto sut = make_dds_stream(one_joint(domain, "rt/gaps"), clock).value();
  const JointState message{.name = {"a"}, .position = {1.0}};
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(sut->open(sink).has_value());
    const std::size_t before = sink.size();
    ASSERT_TRUE(eventually([&] {
      publisher->publish(message);
      return sink.size() >= before + 10;
    }));
    sut->close();
    for (int i = 0; i < 20; ++i) publisher->publish(message);
  }
  EXPECT_EQ(sut->status().lost, 0U);
  EXPECT_EQ(sut->status().received, sink.size());
}

TEST(DdsRecovery, ASampleThatIsTooLongIsRefusedWithItsLength) {
  const int domain = test_domain(4);
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain, "rt/long"), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  auto publisher = JointStatePublisher::make({.domain = domain, .topic = "rt/long"}).value();
  const JointState message{.name = {std::string(std::size_t{2} << 20, 'x')}, .position = {1.0}};
  ASSERT_TRUE(eventually([&] {
    publisher->publish(message);
    return sut->status().rejected > 0;
  }));
  ASSERT_FALSE(sut->status().last_errors.empty());
  const std::string error = sut->status().last_errors.back();
  EXPECT_EQ(error.find("a sample of 2097"), 0U) << error;
  EXPECT_NE(error.find("at most 1048576"), std::string::npos) << error;
  EXPECT_EQ(sink.size(), 0U);
}

TEST(DdsRecovery, APublisherThatEndsInOrderIsNoPublisherAtOnce) {
  const int domain = test_domain(5);
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain, "rt/ends"), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  auto publisher = JointStatePublisher::make({.domain = domain, .topic = "rt/ends"}).value();
  ASSERT_TRUE(eventually([&] {
    publisher->publish({.name = {"a"}, .position = {1.0}});
    return sink.size() > 10;
  }));
  const Timestamp end = clock.now();
  publisher.reset();
  EXPECT_TRUE(eventually([&] { return sut->status().condition.starts_with("no publisher"); }))
      << sut->status().condition;
  EXPECT_LT(seconds(clock.now() - end), 8.0) << "before the lease of a killed one ends, which takes 10 s";
  EXPECT_EQ(sut->status().lost, 0U);
}

TEST(DdsRecovery, FindsMoreParticipantsThanDdsLooksForByDefault) {
  constexpr int kPublishers = 14;  // without multicast: the library's default is 4, Cyclone's limit 10
  const int domain = test_domain(7);
  std::vector<std::unique_ptr<ChildProcess>> publishers;
  for (int i = 0; i < kPublishers; ++i) {
    publishers.push_back(std::make_unique<ChildProcess>(
        "dds_publisher_peer", std::vector<std::string>{std::to_string(domain), "rt/many", "a"}));
  }
  ASSERT_TRUE(eventually([&] { return publishers.back()->lines() > 0; })) << "the last one has not started";
  SystemClock clock;
  CollectingSink sink;
  const auto sut = make_dds_stream(one_joint(domain, "rt/many"), clock).value();
  ASSERT_TRUE(sut->open(sink).has_value());
  const std::string all = std::to_string(kPublishers) + " publishers";
  EXPECT_TRUE(eventually([&] { return sut->status().condition == all; })) << sut->status().condition;
}

TEST(DdsRecovery, OpeningAndClosingUnderLoadPushesNothingAfterwards) {
  const int domain = test_domain(5);
  SystemClock clock;
  std::atomic<bool> done = false;
  auto publisher = JointStatePublisher::make({.domain = domain, .topic = "rt/churn"}).value();
  std::thread sender([&] {
    const JointState message{.name = {"a", "b"}, .position = {1.0, 2.0}};
    while (!done) {
      publisher->publish(message);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  CollectingSink a_sink;
  CollectingSink b_sink;
  const auto a = make_dds_stream(one_joint(domain, "rt/churn", "a"), clock).value();
  const auto b = make_dds_stream(one_joint(domain, "rt/churn", "b"), clock).value();
  for (int round = 0; round < 20; ++round) {
    ASSERT_TRUE(a->open(a_sink).has_value());
    ASSERT_TRUE(b->open(b_sink).has_value());
    const std::size_t a_before = a_sink.size();
    EXPECT_TRUE(eventually([&] { return a_sink.size() > a_before; }));
    static_cast<void>(a->status());
    a->close();
    const std::size_t at_close = a_sink.size();
    const std::size_t b_before = b_sink.size();
    EXPECT_TRUE(eventually([&] { return b_sink.size() > b_before; }));
    EXPECT_EQ(a_sink.size(), at_close);
    b->close();
  }
  done = true;
  sender.join();
}

}  // namespace
}  // namespace cellmirror::dds::test
