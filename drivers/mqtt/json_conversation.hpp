// The gateway's topics with plain JSON (docs/mqtt.md): what goes out, and commands that come in. No connection.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/mqtt/command_request.hpp"
#include "drivers/mqtt/conversation.hpp"
#include "drivers/mqtt/outbox.hpp"
#include "drivers/mqtt/payloads.hpp"
#include "drivers/mqtt/topics.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mqtt_config.hpp"

namespace cellmirror::mqtt {

using CommandAnswer = std::function<void(bool done, std::string_view text)>;

// What becomes of commands. By the connection's thread; neither may wait.
struct CommandHandlers {
  // `answer`: called once, by any thread, also after the gateway's connection has ended.
  std::function<void(std::string command, CommandAnswer answer)> take;
  // One that was refused here: for the log of commands. Not each of a flood.
  std::function<void(std::string_view command, const std::string& why)> refused;
};

class JsonConversation final : public Conversation, public std::enable_shared_from_this<JsonConversation> {
 public:
  static constexpr std::size_t kMostWaitingCommands = 64;
  static constexpr Nanoseconds kBirthEvery{60'000'000'000};  // it overwrites what others have put in its place
  static constexpr Nanoseconds kFloodToldEvery{1'000'000'000};

  // `clock` outlives it. `wake` is called after anything was put, by the thread that did.
  JsonConversation(const MqttConfig& config, Identity identity, const Clock& clock, CommandHandlers handlers,
                   std::function<void()> wake);

  // Any thread, from here to counters().
  void summary(const CellSummary& summary, std::string_view text);
  void collision(const ProximityEvent& event);
  void alarm(std::string_view line);
  void joint_states(std::span<const RobotState> robots, Timestamp time);
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const;

  [[nodiscard]] Outgoing begin() override;
  [[nodiscard]] std::vector<std::string> subscriptions() const override;
  void connected() override;
  [[nodiscard]] std::optional<Outgoing> next() override;
  void received(const Incoming& message) override;
  void lost(std::vector<Outgoing> unconfirmed) override;
  [[nodiscard]] std::vector<Outgoing> farewell() override;

 private:
  struct ReplyTo {
    std::string topic;
    std::string id;
    std::string correlation;
  };

  [[nodiscard]] std::int64_t wall_ms() const;
  [[nodiscard]] EventStamp stamp();             // with the lock
  void put(Outgoing message);                   // with the lock
  void put_event(std::string payload);          // with the lock
  void put_birth();                             // with the lock
  void changes_of(const CellSummary& summary);  // with the lock
  void reply(const ReplyTo& to, bool done, std::string_view text);
  void refuse(const ReplyTo* to, std::string_view command, const std::string& why);
  void refuse_flood();

  const Topics topics_;
  const Identity identity_;
  const bool commands_;
  const Clock& clock_;
  const CommandHandlers handlers_;
  const std::function<void()> wake_;

  mutable std::mutex mutex_;  // of what follows, up to the gate
  Outbox outbox_;
  std::uint64_t events_ = 0;
  bool online_ = false;
  Timestamp last_birth_;
  std::map<std::string, DataState> states_;  // of mirrored robots, as told
  std::optional<std::uint64_t> faults_;      // none: no summary yet
  std::uint64_t commands_taken_ = 0;
  std::uint64_t commands_refused_ = 0;
  std::uint64_t retained_ignored_ = 0;
  std::uint64_t flooded_ = 0;

  CommandGate gate_;  // the connection's thread, as what follows
  Timestamp flood_told_;
  std::uint64_t flood_untold_ = 0;
  std::shared_ptr<std::atomic<std::uint64_t>> waiting_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace cellmirror::mqtt
