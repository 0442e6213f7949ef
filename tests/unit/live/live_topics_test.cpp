// Topics that clients watch, between the recorder and the feed.
#include "app/live/live_topics.hpp"

#include <gtest/gtest.h>

#include <map>

#include "app/recorder/output_messages.hpp"
#include "app/recorder/recording_hub.hpp"

namespace cellmirror::app {
namespace {

class LiveTopicsTest : public testing::Test {
 protected:
  LiveTopicsTest() { hub_.set_live(sut_); }

  // Channel ids by topic.
  static std::map<std::string, std::uint32_t> channels(foxglove::TopicFeed::Subscriber& client) {
    std::map<std::string, std::uint32_t> out;
    for (const foxglove::Channel& channel : client.new_channels()) out[channel.topic] = channel.id;
    return out;
  }

  SystemClock clock_;
  std::shared_ptr<LiveTopics> sut_ = std::make_shared<LiveTopics>();
  RecordingHub hub_{clock_};
};

TEST_F(LiveTopicsTest, NothingIsMadeWhileNobodyWatches) {
  EXPECT_EQ(hub_.rate_hz(), 0.0);
  EXPECT_FALSE(hub_.wants(*OutputTopics::tf()));
  const auto client = sut_->feed().join([] {});
  EXPECT_EQ(hub_.rate_hz(), LiveTopics::kUsualRate_hz);
  EXPECT_FALSE(hub_.wants(*OutputTopics::tf())) << "it has not subscribed yet";
  sut_->set_rate_hz(20);
  EXPECT_EQ(hub_.rate_hz(), 20.0);
}

TEST_F(LiveTopicsTest, WhatIsPutReachesThoseWhoSubscribe) {
  const auto client = sut_->feed().join([] {});
  const auto known = channels(*client);
  for (const char* topic : {"/joint_states", "/tf", "/rosout", "/cellmirror/commands", "/cellmirror/status"})
    EXPECT_TRUE(known.contains(topic)) << topic;
  ASSERT_TRUE(client->subscribe({1, known.at("/cellmirror/commands")}));
  const TopicPtr commands = OutputTopics::commands();
  EXPECT_TRUE(hub_.wants(*commands));
  EXPECT_FALSE(hub_.wants(*OutputTopics::tf()));
  const std::int64_t before = to_wall_clock_ns(clock_.now());
  hub_.put(commands, 1, mcap::view_of("{}"));
  hub_.put(OutputTopics::tf(), 1, mcap::view_of("x"));
  const auto message = client->next();
  ASSERT_TRUE(message);
  EXPECT_EQ(*message->payload, "{}");
  EXPECT_GE(static_cast<std::int64_t>(message->time_ns), before) << "the time of recording, as in a file";
  EXPECT_FALSE(client->next());
  hub_.count_missed(commands, 3);
  EXPECT_EQ(sut_->feed().status().channels.at(0).dropped, 3U);
}

TEST_F(LiveTopicsTest, ATopicThatComesLaterIsAdvertised) {
  const auto client = sut_->feed().join([] {});
  channels(*client);
  EXPECT_FALSE(hub_.wants(*OutputTopics::range("USS_1")));
  const auto later = channels(*client);
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later.begin()->first, "/cellmirror/range/USS_1");
}

TEST_F(LiveTopicsTest, OfStatesTheNewestWaitAndEventsAllDo) {
  const auto client = sut_->feed().join([] {});
  const auto known = channels(*client);
  ASSERT_TRUE(client->subscribe({1, known.at("/tf")}));
  ASSERT_TRUE(client->subscribe({2, known.at("/rosout")}));
  for (int i = 0; i < 500; ++i) {
    hub_.put(OutputTopics::tf(), 1, mcap::view_of("t"));
    hub_.put(OutputTopics::log(), 1, mcap::view_of("l"));
  }
  std::map<std::uint32_t, int> waiting;
  while (const auto message = client->next()) ++waiting[message->subscription];
  EXPECT_EQ(waiting[1], 4);
  EXPECT_EQ(waiting[2], 500);
}

}  // namespace
}  // namespace cellmirror::app
