#include "ipc/foxglove/topic_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace cellmirror::foxglove {

std::unique_ptr<TopicFeed::Subscriber> TopicFeed::join(std::function<void()> wake) {
  std::unique_ptr<Subscriber> made(new Subscriber(*this, std::move(wake)));
  const std::scoped_lock lock(mutex_);
  subscribers_.insert(made.get());
  return made;
}

std::size_t TopicFeed::clients() const {
  const std::scoped_lock lock(mutex_);
  return subscribers_.size();
}

void TopicFeed::leave(Subscriber& subscriber) {
  const std::scoped_lock lock(mutex_);
  for (const auto& state : states_)
    std::erase_if(state->subscriptions, [&](const auto& one) { return one.first == &subscriber; });
  subscribers_.erase(&subscriber);
}

TopicFeed::State* TopicFeed::state_of(const ChannelView& channel) {
  const auto same = [&](const State* state) {
    return state->channel.encoding == channel.encoding && state->channel.schema_name == channel.schema_name &&
           state->channel.schema_encoding == channel.schema_encoding;
  };
  if (const auto found = by_topic_.find(channel.topic); found != by_topic_.end()) {
    if (const auto known = std::ranges::find_if(found->second, same); known != found->second.end()) return *known;
  }
  if (states_.size() >= kMostChannels) return nullptr;
  auto made = std::make_unique<State>();
  made->channel = {static_cast<std::uint32_t>(states_.size() + 1),
                   std::string(channel.topic),
                   std::string(channel.encoding),
                   std::string(channel.schema_name),
                   std::string(channel.schema),
                   std::string(channel.schema_encoding)};
  made->depth = channel.depth;
  by_topic_[made->channel.topic].push_back(made.get());
  states_.push_back(std::move(made));
  return states_.back().get();
}

bool TopicFeed::wants(const ChannelView& channel) {
  const std::scoped_lock lock(mutex_);
  const State* state = state_of(channel);
  return state != nullptr && !state->subscriptions.empty();
}

void TopicFeed::put(const ChannelView& channel, std::uint64_t time_ns, std::string_view data) {
  std::vector<std::function<void()>> to_wake;
  {
    const std::scoped_lock lock(mutex_);
    State* state = state_of(channel);
    if (state == nullptr || state->subscriptions.empty()) return;
    const auto payload = std::make_shared<const std::string>(data);
    for (const auto& [subscriber, subscription] : state->subscriptions) {
      state->dropped += subscriber->queue_.push(subscription, time_ns, payload);
      if (!std::exchange(subscriber->woken_, true)) to_wake.push_back(subscriber->wake_);
    }
  }
  for (const auto& wake : to_wake) wake();
}

void TopicFeed::count_missed(std::string_view topic, std::uint64_t messages) {
  const std::scoped_lock lock(mutex_);
  const auto found = by_topic_.find(topic);
  if (found == by_topic_.end()) return;
  for (State* state : found->second) state->dropped += messages * state->subscriptions.size();
}

FeedStatus TopicFeed::status() const {
  const std::scoped_lock lock(mutex_);
  FeedStatus out{subscribers_.size(), {}};
  for (const auto& state : states_) {
    if (state->was_subscribed)
      out.channels.push_back({state->channel.topic, state->subscriptions.size(), state->sent, state->dropped});
  }
  return out;
}

TopicFeed::Subscriber::~Subscriber() { feed_.leave(*this); }

std::expected<void, std::string> TopicFeed::Subscriber::subscribe(Subscription subscription) {
  const std::scoped_lock lock(feed_.mutex_);
  const auto refused = [](std::string why) { return std::unexpected(std::move(why)); };
  if (subscription.channel == 0 || subscription.channel > feed_.states_.size())
    return refused(fmt::format("there is no channel {}", subscription.channel));
  if (channels_.contains(subscription.id))
    return refused(fmt::format("the subscription {} is in use already", subscription.id));
  if (subscribed_.contains(subscription.channel))
    return refused(fmt::format("the channel {} is subscribed to already", subscription.channel));
  if (channels_.size() >= kMostSubscriptions) return refused("there are too many subscriptions");
  State& state = *feed_.states_[subscription.channel - 1];
  channels_.emplace(subscription.id, subscription.channel);
  subscribed_.insert(subscription.channel);
  queue_.open(subscription.id, state.depth);
  state.subscriptions.emplace_back(this, subscription.id);
  state.was_subscribed = true;
  return {};
}

bool TopicFeed::Subscriber::unsubscribe(std::uint32_t subscription) {
  const std::scoped_lock lock(feed_.mutex_);
  const auto found = channels_.find(subscription);
  if (found == channels_.end()) return false;
  std::erase(feed_.states_[found->second - 1]->subscriptions,
             std::pair<Subscriber*, std::uint32_t>(this, subscription));
  subscribed_.erase(found->second);
  channels_.erase(found);
  queue_.close(subscription);
  return true;
}

std::optional<Waiting> TopicFeed::Subscriber::next() {
  const std::scoped_lock lock(feed_.mutex_);
  auto out = queue_.pop();
  woken_ = out.has_value();
  if (out) ++feed_.states_[channels_.at(out->subscription) - 1]->sent;
  return out;
}

bool TopicFeed::Subscriber::waiting() const {
  const std::scoped_lock lock(feed_.mutex_);
  return !queue_.empty();
}

std::vector<Channel> TopicFeed::Subscriber::new_channels() {
  const std::scoped_lock lock(feed_.mutex_);
  std::vector<Channel> out;
  for (; given_ < feed_.states_.size(); ++given_) out.push_back(feed_.states_[given_]->channel);
  return out;
}

std::map<std::string, std::uint64_t> TopicFeed::Subscriber::dropped() const {
  const std::scoped_lock lock(feed_.mutex_);
  std::map<std::string, std::uint64_t> out;
  for (const auto& [subscription, channel] : channels_) {
    if (const std::uint64_t count = queue_.dropped(subscription); count > 0)
      out[feed_.states_[channel - 1]->channel.topic] += count;
  }
  return out;
}

}  // namespace cellmirror::foxglove
