#include "drivers/mqtt/mqtt_gateway.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

#include "drivers/mqtt/broker_link.hpp"
#include "drivers/mqtt/sparkplug_conversation.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr double kLeastLook_hz = 10;  // for collisions

std::string client_id_of(const MqttConfig& config, const Identity& identity) {
  if (!config.client_id.empty()) return config.client_id;
  return fmt::format("cellmirror-{}-{}-{}", topic_level(identity.host), topic_level(identity.cell),
                     topic_level(identity.instance));
}

}  // namespace

struct MqttGateway::Impl {
  Impl(const MqttConfig& given, const Identity& identity, const Clock& time, CommandHandlers handlers)
      : config(given),
        json(std::make_shared<JsonConversation>(given, identity, time, std::move(handlers),
                                                [signal = json_wake] { signal->wake(); })),
        json_link(given, client_id_of(given, identity), *json, *json_wake, time) {
    if (!given.sparkplug) return;
    node = std::make_unique<SparkplugConversation>(*given.sparkplug, identity, time,
                                                   [signal = node_wake] { signal->wake(); });
    node_link =
        std::make_unique<BrokerLink>(given, client_id_of(given, identity) + "-sparkplug", *node, *node_wake, time);
  }

  MqttConfig config;
  // Answers to commands may come when all else has ended.
  std::shared_ptr<WakeSignal> json_wake = std::make_shared<WakeSignal>();
  std::shared_ptr<WakeSignal> node_wake = std::make_shared<WakeSignal>();
  std::shared_ptr<JsonConversation> json;
  BrokerLink json_link;
  std::unique_ptr<SparkplugConversation> node;  // null: not wanted
  std::unique_ptr<BrokerLink> node_link;        // likewise
};

namespace {

class Summaries final : public SummaryOutput {
 public:
  Summaries(std::string name, JsonConversation& json, SparkplugConversation* node)
      : name_(std::move(name)), json_(json), node_(node) {}

  void publish(const CellSummary& summary, std::string_view text) override {
    ++published_;
    json_.summary(summary, text);
    if (node_ != nullptr) node_->summary(summary);
  }
  // What becomes of them is with the others: they are replaced by newer ones, never dropped.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    return {{"published", published_}};
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::string name_;
  JsonConversation& json_;
  SparkplugConversation* node_;
  std::atomic<std::uint64_t> published_{0};
};

class States final : public StatesOutput {
 public:
  States(const MqttGateway& gateway, double rate_hz, JsonConversation& json, SparkplugConversation* node)
      : gateway_(gateway), json_(json), node_(node) {
    if (rate_hz > 0) period_ = Nanoseconds(std::llround(1e9 / rate_hz));
  }

  void publish(Timestamp time, std::span<const RobotState> robots, std::span<const FramePose> /*frames*/) override {
    // Half of a look early is near enough: otherwise each would be a whole one late.
    constexpr Nanoseconds kEarly{static_cast<std::int64_t>(0.5e9 / (2 * kLeastLook_hz))};
    if (period_ == Nanoseconds{0} || (due_.known() && time + std::min(kEarly, period_ / 2) < due_)) return;
    due_ = due_.known() && time - due_ < period_ ? due_ + period_ : time + period_;
    json_.joint_states(robots, time);
    if (node_ != nullptr) node_->joint_states(robots);
  }
  void publish_proximity(const ProximityState& state) override {
    for (const ProximityEvent& event : state.events) json_.collision(event);
  }
  void publish_ranges(std::span<const RangeReading> /*readings*/, RangeSendMode /*mode*/) override {}
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override {
    return gateway_.counters();
  }
  [[nodiscard]] std::string name() const override { return gateway_.name(); }

 private:
  const MqttGateway& gateway_;
  Nanoseconds period_{0};
  Timestamp due_;
  JsonConversation& json_;
  SparkplugConversation* node_;
};

}  // namespace

MqttGateway::MqttGateway(const MqttConfig& config, const Identity& identity, const Clock& clock,
                         CommandHandlers handlers)
    : impl_(std::make_unique<Impl>(config, identity, clock, std::move(handlers))) {
  impl_->json_link.start();
  if (impl_->node_link) impl_->node_link->start();
}

MqttGateway::~MqttGateway() { stop(); }

void MqttGateway::stop() {
  impl_->json_link.stop();
  if (impl_->node_link) impl_->node_link->stop();
}

std::unique_ptr<SummaryOutput> MqttGateway::summary_output() {
  return std::make_unique<Summaries>(name() + " summary", *impl_->json, impl_->node.get());
}

std::unique_ptr<StatesOutput> MqttGateway::states_output() {
  return std::make_unique<States>(*this, impl_->config.joint_states_hz, *impl_->json, impl_->node.get());
}

double MqttGateway::states_rate_hz() const { return std::max(kLeastLook_hz, impl_->config.joint_states_hz); }

void MqttGateway::alarm(std::string_view line) { impl_->json->alarm(line); }

std::vector<std::pair<std::string, std::uint64_t>> MqttGateway::counters() const {
  std::vector<std::pair<std::string, std::uint64_t>> out;
  const auto add = [&out](const std::string& prefix, const BrokerLink& link) {
    const BrokerLink::Counters of = link.counters();
    out.insert(out.end(), {{prefix + "connected", link.connected() ? 1 : 0},
                           {prefix + "sent", of.sent},
                           {prefix + "sent_bytes", of.sent_bytes},
                           {prefix + "refused", of.refused},
                           {prefix + "received", of.received},
                           {prefix + "connections", of.connections},
                           {prefix + "failures", of.failures}});
  };
  add("", impl_->json_link);
  const auto json = impl_->json->counters();
  std::uint64_t dropped = 0;
  for (const auto& [key, value] : json) dropped += key.ends_with("_dropped") ? value : 0;
  out.emplace_back("dropped", dropped);
  out.insert(out.end(), json.begin(), json.end());
  if (impl_->node_link) {
    add("sparkplug_", *impl_->node_link);
    const auto node = impl_->node->counters();
    out.insert(out.end(), node.begin(), node.end());
  }
  return out;
}

std::string MqttGateway::name() const { return fmt::format("mqtt {}:{}", impl_->config.broker, impl_->config.port); }

std::string MqttGateway::problem() const {
  std::string text = impl_->json_link.problem();
  return text.empty() && impl_->node_link ? impl_->node_link->problem() : text;
}

}  // namespace cellmirror::mqtt
