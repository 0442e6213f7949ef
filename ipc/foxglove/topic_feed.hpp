// The channels that clients may subscribe to, and what waits for each client. Messages come from any thread but the
// tick's; what a client does not read is left out (FairQueue) and counted by channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/foxglove/fair_queue.hpp"
#include "ipc/foxglove/server_message.hpp"

namespace cellmirror::foxglove {

// A channel without its id. Topic, encodings and the name of the schema make a channel.
struct ChannelView {
  std::string_view topic;
  std::string_view encoding;
  std::string_view schema_name;
  std::string_view schema;
  std::string_view schema_encoding;
  std::size_t depth = 1;  // messages that may wait for a client
};

struct ChannelStatus {
  std::string topic;
  std::size_t subscribers = 0;
  std::uint64_t sent = 0;     // given to a client; one message to two clients counts twice
  std::uint64_t dropped = 0;  // left out, likewise
};

struct FeedStatus {
  std::size_t clients = 0;
  std::vector<ChannelStatus> channels;  // those that were subscribed to since the start
};

class TopicFeed {
 public:
  static constexpr std::size_t kMostChannels = 1024;
  static constexpr std::size_t kMostSubscriptions = 1024;  // of a client

  // What waits for one client. Any thread. Outlived by the feed.
  class Subscriber {
   public:
    ~Subscriber();
    Subscriber(const Subscriber&) = delete;
    Subscriber& operator=(const Subscriber&) = delete;

    // The error says why not.
    [[nodiscard]] std::expected<void, std::string> subscribe(Subscription subscription);
    // False: there is no such subscription.
    bool unsubscribe(std::uint32_t subscription);
    [[nodiscard]] std::optional<Waiting> next();
    [[nodiscard]] bool waiting() const;
    // Channels that were not given yet, oldest first.
    [[nodiscard]] std::vector<Channel> new_channels();
    // Messages that were left out for this client, by topic; only topics of which some were.
    [[nodiscard]] std::map<std::string, std::uint64_t> dropped() const;

   private:
    friend class TopicFeed;
    Subscriber(TopicFeed& feed, std::function<void()> wake) : feed_(feed), wake_(std::move(wake)) {}

    TopicFeed& feed_;
    std::function<void()> wake_;
    // With the feed's lock.
    FairQueue queue_;
    std::map<std::uint32_t, std::uint32_t> channels_;  // by subscription
    std::set<std::uint32_t> subscribed_;               // channels
    std::size_t given_ = 0;                            // channels
    bool woken_ = false;
  };

  TopicFeed() = default;
  TopicFeed(const TopicFeed&) = delete;
  TopicFeed& operator=(const TopicFeed&) = delete;

  // `wake` is called when something comes for a client that nothing waited for; by the thread that brings it, which
  // must not be held up.
  [[nodiscard]] std::unique_ptr<Subscriber> join(std::function<void()> wake);
  [[nodiscard]] std::size_t clients() const;

  // Whether a client subscribes to the channel. It is made where it is not there.
  bool wants(const ChannelView& channel);
  // `time_ns`: since 1970, UTC.
  void put(const ChannelView& channel, std::uint64_t time_ns, std::string_view data);
  // Messages that were never made.
  void count_missed(std::string_view topic, std::uint64_t messages);
  [[nodiscard]] FeedStatus status() const;

 private:
  struct State {
    Channel channel;
    std::size_t depth = 1;
    std::vector<std::pair<Subscriber*, std::uint32_t>> subscriptions;
    bool was_subscribed = false;
    std::uint64_t sent = 0;
    std::uint64_t dropped = 0;
  };

  State* state_of(const ChannelView& channel);  // null: there are too many
  void leave(Subscriber& subscriber);

  mutable std::mutex mutex_;                    // of all of it, and of what subscribers have
  std::vector<std::unique_ptr<State>> states_;  // by id - 1
  std::map<std::string, std::vector<State*>, std::less<>> by_topic_;
  std::set<Subscriber*> subscribers_;
};

}  // namespace cellmirror::foxglove
