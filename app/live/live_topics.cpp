#include "app/live/live_topics.hpp"

#include <string_view>

#include "app/recorder/output_messages.hpp"

namespace cellmirror::app {

namespace {

// How many messages may wait for a client: of states the newest ones count, events should all arrive.
std::size_t depth_of(Importance importance) {
  switch (importance) {
    case Importance::picture:
    case Importance::bulk:
      return 4;
    case Importance::state:
      return 16;
    case Importance::event:
      return 1000;
  }
  return 1;
}

foxglove::ChannelView channel_of(const Topic& topic) {
  return {topic.name,   topic.encoding,        topic.schema_name,
          topic.schema, topic.schema_encoding, depth_of(topic.importance)};
}

}  // namespace

LiveTopics::LiveTopics() {
  for (const TopicPtr& topic :
       {OutputTopics::joint_states({}), OutputTopics::tf(), OutputTopics::log(), OutputTopics::collisions(),
        OutputTopics::collision_events(), OutputTopics::forces(), OutputTopics::commands(), OutputTopics::status()})
    feed_.wants(channel_of(*topic));
}

void LiveTopics::put(const TopicPtr& topic, std::int64_t log_time_ns, std::int64_t /*publish_time_ns*/,
                     mcap::View data) {
  feed_.put(channel_of(*topic), static_cast<std::uint64_t>(log_time_ns),
            {reinterpret_cast<const char*>(data.data()), data.size()});
}

void LiveTopics::count_missed(const TopicPtr& topic, std::uint64_t messages) {
  feed_.count_missed(topic->name, messages);
}

bool LiveTopics::wants(const Topic& topic) const { return feed_.wants(channel_of(topic)); }

double LiveTopics::wanted_rate_hz() const {
  const std::scoped_lock lock(mutex_);
  return rate_hz_;
}

void LiveTopics::set_rate_hz(double rate_hz) {
  const std::scoped_lock lock(mutex_);
  rate_hz_ = rate_hz;
}

double LiveTopics::rate_hz() const { return feed_.clients() > 0 ? wanted_rate_hz() : 0.0; }

}  // namespace cellmirror::app
