#include "drivers/mqtt/sparkplug_conversation.hpp"

#include "rt_core/base/log.hpp"

namespace cellmirror::mqtt {

void SparkplugConversation::summary(const CellSummary& summary) {
  {
    const std::scoped_lock lock(mutex_);
    node_.see(summary);
  }
  wake_();
}

void SparkplugConversation::joint_states(std::span<const RobotState> robots) {
  for (const RobotState& robot : robots) {
    const std::scoped_lock lock(mutex_);
    node_.see(robot);
  }
  wake_();
}

std::vector<std::pair<std::string, std::uint64_t>> SparkplugConversation::counters() const {
  const std::scoped_lock lock(mutex_);
  return {{"sparkplug_rebirths", rebirths_}, {"sparkplug_commands_refused", commands_refused_}};
}

Outgoing SparkplugConversation::begin() {
  const std::scoped_lock lock(mutex_);
  return node_.begin_session(wall_ms());
}

void SparkplugConversation::connected() {
  const std::scoped_lock lock(mutex_);
  node_.bear_again();
}

std::optional<Outgoing> SparkplugConversation::next() {
  const std::scoped_lock lock(mutex_);
  return node_.next(wall_ms());
}

// The next connection begins with birth messages: nothing is given back.
void SparkplugConversation::lost(std::vector<Outgoing> /*unconfirmed*/) {
  const std::scoped_lock lock(mutex_);
  node_.disconnected();
}

std::vector<Outgoing> SparkplugConversation::farewell() {
  const std::scoped_lock lock(mutex_);
  return {node_.death(wall_ms())};
}

void SparkplugConversation::received(const Incoming& message) {
  const auto wanted = message.retained ? fail("it is retained, so it is old") : asks_for_rebirth(message.payload);
  const std::scoped_lock lock(mutex_);
  if (!wanted || !*wanted) {
    ++commands_refused_;
    return log_warning("mqtt.sparkplug", "a command to the edge node was refused: {}",
                       wanted ? std::string("it is not Node Control/Rebirth") : wanted.error().text());
  }
  const Timestamp now = clock_.now();
  if (last_rebirth_.known() && now - last_rebirth_ < kRebirthEvery) {
    ++commands_refused_;
    return;
  }
  last_rebirth_ = now;
  ++rebirths_;
  node_.bear_again();
}

}  // namespace cellmirror::mqtt
