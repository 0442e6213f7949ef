// The edge node (sparkplug_node.hpp) in conversation with a broker: locks it, and hears its commands.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drivers/mqtt/conversation.hpp"
#include "drivers/mqtt/sparkplug_node.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::mqtt {

class SparkplugConversation final : public Conversation {
 public:
  static constexpr Nanoseconds kRebirthEvery{1'000'000'000};  // at most, whatever comes

  // `clock` outlives it. `wake` is called after anything was put, by the thread that did.
  // Reads and writes `config.session_file`; what fails there is logged.
  SparkplugConversation(const SparkplugConfig& config, const Identity& identity, const Clock& clock,
                        std::function<void()> wake);

  // Any thread.
  void summary(const CellSummary& summary);
  void joint_states(std::span<const RobotState> robots);
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const;

  [[nodiscard]] Outgoing begin() override;
  void asked() override;
  [[nodiscard]] std::vector<std::string> subscriptions() const override { return {node_.command_topic()}; }
  void connected() override;
  [[nodiscard]] std::optional<Outgoing> next() override;
  void received(const Incoming& message) override;
  void lost(std::vector<Outgoing> unconfirmed) override;
  [[nodiscard]] std::vector<Outgoing> farewell() override;

 private:
  [[nodiscard]] std::int64_t wall_ms() const { return machine_wall_clock_ns(clock_.now()) / 1'000'000; }

  const Clock& clock_;
  const std::function<void()> wake_;
  const std::string session_file_;
  mutable std::mutex mutex_;  // of what follows
  SparkplugNode node_;
  Timestamp last_rebirth_;
  std::uint64_t rebirths_ = 0;
  std::uint64_t commands_refused_ = 0;
};

}  // namespace cellmirror::mqtt
