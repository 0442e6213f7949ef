#include "drivers/mqtt/sparkplug_conversation.hpp"

#include "drivers/mqtt/session_file.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::mqtt {

namespace {

std::uint8_t first_session(const std::string& file) {
  if (file.empty()) return 0;
  const auto last = read_session(file);
  if (!last) log_warning("mqtt.sparkplug", "the number of the session begins at 0: {}", last.error().text());
  return last && *last ? static_cast<std::uint8_t>(**last + 1) : std::uint8_t{0};
}

}  // namespace

SparkplugConversation::SparkplugConversation(const SparkplugConfig& config, const Identity& identity,
                                             const Clock& clock, std::function<void()> wake)
    : clock_(clock),
      wake_(std::move(wake)),
      session_file_(config.session_file),
      node_(config, identity, first_session(config.session_file)) {}

void SparkplugConversation::asked() {
  std::uint8_t session = 0;
  {
    const std::scoped_lock lock(mutex_);
    session = node_.asked();
  }
  if (session_file_.empty()) return;
  if (const auto written = write_session(session_file_, session); !written)
    log_warning("mqtt.sparkplug", "the number of the session is not kept: {}", written.error().text());
}

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
