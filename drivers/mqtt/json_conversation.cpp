#include "drivers/mqtt/json_conversation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr std::int64_t kNsOfMs = 1'000'000;

}  // namespace

JsonConversation::JsonConversation(const MqttConfig& config, Identity identity, const Clock& clock,
                                   CommandHandlers handlers, std::function<void()> wake)
    : topics_(config.prefix, identity.cell),
      identity_(std::move(identity)),
      commands_(config.commands),
      clock_(clock),
      handlers_(std::move(handlers)),
      wake_(std::move(wake)),
      gate_(config.commands_per_s) {}

// Of the machine, also where a recording is played.
std::int64_t JsonConversation::wall_ms() const { return machine_wall_clock_ns(clock_.now()) / kNsOfMs; }

EventStamp JsonConversation::stamp() { return {++events_, wall_ms()}; }

void JsonConversation::put(Outgoing message) { outbox_.put(std::move(message)); }

void JsonConversation::put_event(std::string payload) {
  put({.kind = Outgoing::Kind::event, .topic = topics_.event(), .payload = std::move(payload), .qos = 1});
}

void JsonConversation::put_birth() {
  last_birth_ = clock_.now();
  put({.kind = Outgoing::Kind::retained,
       .topic = topics_.state(),
       .payload = birth_text(identity_, commands_, wall_ms()),
       .qos = 1,
       .retain = true});
}

// Streams that are lost and come back, and faults, are changes from summary to summary: a new one comes at once.
void JsonConversation::changes_of(const CellSummary& summary) {
  if (faults_ && summary.loop.faults > *faults_) put_event(fault_text(stamp(), summary));
  faults_ = summary.loop.faults;
  std::map<std::string, DataState> states;
  for (const RobotSummary& robot : summary.robots) {
    if (!robot.mirrored) continue;
    const auto known = states_.find(robot.id);
    const DataState was = known == states_.end() ? DataState::none : known->second;
    if (was != robot.state) put_event(stream_text(stamp(), robot, was));
    states.emplace(robot.id, robot.state);
  }
  states_ = std::move(states);
}

void JsonConversation::summary(const CellSummary& summary, std::string_view text) {
  {
    const std::scoped_lock lock(mutex_);
    changes_of(summary);
    if (online_ && clock_.now() - last_birth_ >= kBirthEvery) put_birth();
    put({.kind = Outgoing::Kind::retained, .topic = topics_.summary(), .payload = std::string(text), .retain = true});
  }
  wake_();
}

void JsonConversation::collision(const ProximityEvent& event) {
  {
    const std::scoped_lock lock(mutex_);
    put_event(collision_text({++events_, to_wall_clock_ns(event.posture_time) / kNsOfMs}, event));
  }
  wake_();
}

void JsonConversation::alarm(std::string_view line) {
  {
    const std::scoped_lock lock(mutex_);
    put_event(alarm_text(stamp(), line));
  }
  wake_();
}

void JsonConversation::joint_states(std::span<const RobotState> robots, Timestamp time) {
  for (const RobotState& robot : robots) {
    const std::scoped_lock lock(mutex_);
    put({.kind = Outgoing::Kind::joint_states,
         .topic = topics_.joint_states(robot.id),
         .payload = joint_states_text(robot, to_wall_clock_ns(time) / kNsOfMs)});
  }
  wake_();
}

std::vector<std::pair<std::string, std::uint64_t>> JsonConversation::counters() const {
  const std::scoped_lock lock(mutex_);
  const Outbox::Counters& out = outbox_.counters();
  return {{"waiting", outbox_.size()},
          {"waiting_bytes", outbox_.bytes()},
          {"events", events_},
          {"events_dropped", out.events_dropped},
          {"joint_states_dropped", out.joint_states_dropped},
          {"replies_dropped", out.replies_dropped},
          {"replaced", out.replaced},
          {"commands", commands_taken_},
          {"commands_refused", commands_refused_},
          {"commands_flooded", flooded_},
          {"retained_ignored", retained_ignored_}};
}

Outgoing JsonConversation::begin() {
  return {
      .kind = Outgoing::Kind::other, .topic = topics_.state(), .payload = death_text("lost"), .qos = 1, .retain = true};
}

std::vector<std::string> JsonConversation::subscriptions() const {
  return commands_ ? std::vector<std::string>{topics_.command()} : std::vector<std::string>();
}

void JsonConversation::connected() {
  const std::scoped_lock lock(mutex_);
  online_ = true;
  put_birth();
}

std::optional<Outgoing> JsonConversation::next() {
  const std::scoped_lock lock(mutex_);
  return outbox_.take();
}

void JsonConversation::lost(std::vector<Outgoing> unconfirmed) {
  const std::scoped_lock lock(mutex_);
  online_ = false;
  // The next connection has a birth message of its own.
  std::erase_if(unconfirmed, [this](const Outgoing& message) { return message.topic == topics_.state(); });
  outbox_.give_back(std::move(unconfirmed));
}

std::vector<Outgoing> JsonConversation::farewell() {
  Outgoing last = begin();
  last.payload = death_text("stopped");
  return {std::move(last)};
}

void JsonConversation::reply(const ReplyTo& to, bool done, std::string_view text) {
  {
    const std::scoped_lock lock(mutex_);
    put({.kind = Outgoing::Kind::reply,
         .topic = to.topic,
         .payload = reply_text(to.id, done, text, wall_ms()),
         .qos = 1,
         .correlation = to.correlation});
  }
  wake_();
}

void JsonConversation::refuse(const ReplyTo* to, std::string_view command, const std::string& why) {
  {
    const std::scoped_lock lock(mutex_);
    ++commands_refused_;
  }
  if (handlers_.refused) handlers_.refused(command, why);
  if (to != nullptr) reply(*to, false, why);
}

// Answers to each of them would double the flood, and lines in the log would fill the disk.
void JsonConversation::refuse_flood() {
  {
    const std::scoped_lock lock(mutex_);
    ++flooded_;
  }
  ++flood_untold_;
  const Timestamp now = clock_.now();
  if (flood_told_.known() && now - flood_told_ < kFloodToldEvery) return;
  flood_told_ = now;
  const std::string why = fmt::format("{} came faster than commands_per_s of [mqtt] allows", flood_untold_);
  flood_untold_ = 0;
  if (handlers_.refused) handlers_.refused("", why);
  log_warning("mqtt.commands", "commands are refused: {}", why);
  reply({topics_.reply(), {}, {}}, false, why);
}

void JsonConversation::received(const Incoming& message) {
  if (!commands_ || message.topic != topics_.command()) return;
  if (message.retained) {
    const std::scoped_lock lock(mutex_);
    ++retained_ignored_;
    return log_warning("mqtt.retained",
                       "the broker keeps a message on {}: it is old and is not executed; remove it: "
                       "mosquitto_pub -r -n -t TOPIC",
                       printable(message.topic));
  }
  if (!gate_.admit(clock_.now())) return refuse_flood();
  ReplyTo to{topics_.reply(), {}, std::string(message.correlation)};
  const auto request = parse_command(message.payload, to.id);
  if (to.correlation.size() > kMostIdBytes) {
    to.correlation.clear();
    return refuse(&to, "", fmt::format("the correlation data are longer than {} bytes", kMostIdBytes));
  }
  if (!message.response_topic.empty()) {
    if (!topics_.is_reply(message.response_topic))
      return refuse(&to, request ? request->command : std::string(),
                    fmt::format("answers go to {} and topics below it only", topics_.reply()));
    to.topic = std::string(message.response_topic);
  }
  if (!request) return refuse(&to, "", request.error().text());
  if (waiting_->fetch_add(1, std::memory_order_relaxed) >= kMostWaitingCommands) {
    waiting_->fetch_sub(1, std::memory_order_relaxed);
    return refuse(&to, request->command, "too many commands wait for their acknowledgement; try again");
  }
  {
    const std::scoped_lock lock(mutex_);
    ++commands_taken_;
  }
  handlers_.take(request->command, [self = weak_from_this(), to, waiting = waiting_](bool done, std::string_view text) {
    waiting->fetch_sub(1, std::memory_order_relaxed);
    if (const auto here = self.lock()) here->reply(to, done, text);
  });
}

}  // namespace cellmirror::mqtt
