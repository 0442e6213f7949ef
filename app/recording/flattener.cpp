#include "app/recording/flattener.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

Result<FlatMessage> Flattener::flatten(const mcap::Message& message, const mcap::Channel& channel) {
  if (channel.encoding == "json")
    return flatten_json({reinterpret_cast<const char*>(message.data.data()), message.data.size()});
  if (channel.encoding != "cdr")
    return fail(fmt::format("messages of the encoding {} are not supported", printable(channel.encoding)),
                "supported are json, and cdr with a schema ros2msg");
  auto known = schemas_.find(channel.schema);
  if (known == schemas_.end()) known = schemas_.emplace(channel.schema, parse(channel)).first;
  if (!known->second) return std::unexpected(known->second.error());
  return known->second->flatten(message.data);
}

Result<Ros2Schema> Flattener::parse(const mcap::Channel& channel) const {
  const mcap::Schema* schema = catalogue_.schema_of(channel);
  if (schema == nullptr || schema->encoding != "ros2msg")
    return fail(fmt::format("the topic {} has no schema of ROS 2", printable(channel.topic)));
  return Ros2Schema::parse(schema->name, schema->data);
}

Result<void> topic_is_there(const mcap::Reader& reader, const std::string& topic) {
  std::vector<std::string> topics;
  for (const auto& [id, channel] : reader.catalogue().channels) topics.push_back(channel.topic);
  if (std::ranges::find(topics, topic) != topics.end()) return {};
  const std::string meant = did_you_mean(topic, topics);
  return fail(fmt::format("the recording has no topic {}", printable(topic)),
              meant.empty() ? "list them with: cellmirror recording info" : meant);
}

}  // namespace cellmirror::app
