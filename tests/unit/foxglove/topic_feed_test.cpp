#include "ipc/foxglove/topic_feed.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

namespace cellmirror::foxglove {
namespace {

constexpr ChannelView kA = {"/a", "json", "One", "{}", "jsonschema", 2};
constexpr ChannelView kB = {"/b", "cdr", "Two", "int32 x", "ros2msg", 2};

TEST(TopicFeed, ChannelsAreMadeOnceAndGivenOnce) {
  TopicFeed sut;
  EXPECT_FALSE(sut.wants(kA));
  const auto client = sut.join([] {});
  auto channels = client->new_channels();
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].id, 1U);
  EXPECT_EQ(channels[0].topic, "/a");
  EXPECT_EQ(channels[0].schema, "{}");
  sut.wants(kA);
  sut.put(kB, 1, "x");
  channels = client->new_channels();
  ASSERT_EQ(channels.size(), 1U);
  EXPECT_EQ(channels[0].topic, "/b");
  // Another schema of the same topic is another channel: ids are kept for what clients know by them.
  ChannelView other = kA;
  other.schema_name = "Other";
  sut.wants(other);
  EXPECT_EQ(client->new_channels().at(0).id, 3U);
}

TEST(TopicFeed, OnlyWhatIsSubscribedToIsWantedAndKept) {
  TopicFeed sut;
  sut.wants(kA);
  sut.wants(kB);
  const auto client = sut.join([] {});
  ASSERT_TRUE(client->subscribe({7, 1}));
  EXPECT_TRUE(sut.wants(kA));
  EXPECT_FALSE(sut.wants(kB));
  sut.put(kB, 1, "b");
  EXPECT_FALSE(client->waiting());
  sut.put(kA, 5, "a");
  EXPECT_TRUE(client->waiting());
  const auto got = client->next();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->subscription, 7U);
  EXPECT_EQ(got->time_ns, 5U);
  EXPECT_EQ(*got->payload, "a");
  EXPECT_TRUE(client->unsubscribe(7));
  EXPECT_FALSE(client->unsubscribe(7));
  EXPECT_FALSE(sut.wants(kA));
}

TEST(TopicFeed, RefusesWhatTheProtocolForbids) {
  TopicFeed sut;
  sut.wants(kA);
  sut.wants(kB);
  const auto client = sut.join([] {});
  EXPECT_FALSE(client->subscribe({1, 0}));
  EXPECT_FALSE(client->subscribe({1, 3}));
  ASSERT_TRUE(client->subscribe({1, 1}));
  EXPECT_FALSE(client->subscribe({1, 2})) << "an id that is in use";
  EXPECT_FALSE(client->subscribe({2, 1})) << "a channel twice";
  EXPECT_TRUE(client->subscribe({2, 2}));
}

TEST(TopicFeed, CountsWhatASlowClientLoses) {
  TopicFeed sut;
  sut.wants(kA);
  const auto slow = sut.join([] {});
  const auto fast = sut.join([] {});
  ASSERT_TRUE(slow->subscribe({1, 1}));
  ASSERT_TRUE(fast->subscribe({1, 1}));
  for (int i = 0; i < 5; ++i) {
    sut.put(kA, 1, "x");
    EXPECT_TRUE(fast->next());
  }
  EXPECT_EQ(slow->dropped().at("/a"), 3U);
  EXPECT_TRUE(fast->dropped().empty());
  const auto status = sut.status().channels;
  ASSERT_EQ(status.size(), 1U);
  EXPECT_EQ(status[0].topic, "/a");
  EXPECT_EQ(status[0].subscribers, 2U);
  EXPECT_EQ(status[0].sent, 5U);
  EXPECT_EQ(status[0].dropped, 3U);
  sut.count_missed("/a", 2);
  EXPECT_EQ(sut.status().channels[0].dropped, 7U);
  sut.count_missed("/unknown", 2);
}

TEST(TopicFeed, WakesOnceUntilEverythingIsTaken) {
  TopicFeed sut;
  sut.wants(kA);
  int woken = 0;
  const auto client = sut.join([&] { ++woken; });
  ASSERT_TRUE(client->subscribe({1, 1}));
  sut.put(kA, 1, "x");
  sut.put(kA, 2, "x");
  EXPECT_EQ(woken, 1);
  while (client->next()) {
  }
  sut.put(kA, 3, "x");
  EXPECT_EQ(woken, 2);
}

TEST(TopicFeed, ClientsComeAndGoWhileMessagesCome) {
  TopicFeed sut;
  sut.wants(kA);
  std::atomic<bool> stop{false};
  std::thread source([&] {
    for (std::uint64_t i = 0; !stop; ++i) sut.put(kA, i, "message");
  });
  for (int i = 0; i < 200; ++i) {
    const auto client = sut.join([] {});
    ASSERT_TRUE(client->subscribe({1, 1}));
    for (int k = 0; k < 10; ++k) static_cast<void>(client->next());
  }
  stop = true;
  source.join();
  EXPECT_EQ(sut.clients(), 0U);
  EXPECT_FALSE(sut.wants(kA));
}

}  // namespace
}  // namespace cellmirror::foxglove
