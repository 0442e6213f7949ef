// The messages of a recording as values, by the schema of each channel.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/recording/ros2_schema.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

class Flattener {
 public:
  // `catalogue` outlives it.
  explicit Flattener(const mcap::Catalogue& catalogue) : catalogue_(catalogue) {}

  // JSON, and CDR with a schema of ROS 2; fails for others, and where a message does not fit its schema.
  [[nodiscard]] Result<FlatMessage> flatten(const mcap::Message& message, const mcap::Channel& channel);

 private:
  [[nodiscard]] Result<Ros2Schema> parse(const mcap::Channel& channel) const;

  const mcap::Catalogue& catalogue_;
  std::map<std::uint16_t, Result<Ros2Schema>> schemas_;
};

// Fails where the recording has no such topic, with the nearest name.
[[nodiscard]] Result<void> topic_is_there(const mcap::Reader& reader, const std::string& topic);

}  // namespace cellmirror::app
