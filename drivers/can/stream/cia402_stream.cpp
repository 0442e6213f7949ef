#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/cia402/session.hpp"
#include "drivers/can/stream/can_stream.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {
namespace {

std::string_view log_kind(Cia402EventKind kind) {
  switch (kind) {
    case Cia402EventKind::boot_up:
      return "boot-up";
    case Cia402EventKind::node_lost:
    case Cia402EventKind::node_resolved:
      return "heartbeat";
    case Cia402EventKind::emcy:
      return "emcy";
    case Cia402EventKind::configured:
    case Cia402EventKind::configuration_failed:
      return "configuration";
    case Cia402EventKind::tpdo_missing:
      return "tpdo";
    case Cia402EventKind::rejected:
      return "rejected";
    case Cia402EventKind::second_drive:
      return "second drive";
  }
  return "event";
}

Severity severity_of(Cia402EventKind kind) {
  const bool is_good =
      kind == Cia402EventKind::boot_up || kind == Cia402EventKind::node_resolved || kind == Cia402EventKind::configured;
  return is_good ? Severity::note : Severity::warning;
}

class Cia402Protocol final : public CanProtocol, private Cia402SessionOutput {
 public:
  Cia402Protocol(const Cia402Plan& plan, CanProtocolHost& host) : host_(&host), session_(plan, *this) {}

  void start(Timestamp now) override { session_.start(now); }
  void receive(const CanFrame& frame, Timestamp now, std::size_t /*node*/) override { session_.receive(frame, now); }
  void advance(Timestamp now) override { session_.advance(now); }
  [[nodiscard]] Timestamp next_due() const override { return session_.next_due(); }

  void publish() override {
    Report& report = published_.writable();
    report.counters = session_.counters();
    session_.copy_nodes(report.nodes);
    published_.publish();
  }

  void describe(JointStreamStatus& status, Timestamp now) override {
    const auto& [counters, nodes] = published_.read().value;
    status.received = counters.samples;
    status.lost = counters.lost;
    status.rejected = counters.rejected;
    status.condition = condition(nodes, now);
    for (const Cia402NodeStatus& node : nodes) {
      status.details.emplace_back(fmt::format("node {} ({})", node.node_id, node.joint_name), words(node, now));
      if (node.last_emcy) {
        status.details.emplace_back(fmt::format("last EMCY of node {}", node.node_id), text(*node.last_emcy));
      }
    }
    if (counters.syncs + counters.syncs_missed > 0) {
      status.details.emplace_back("SYNC", fmt::format("{} cycles, {} missed", counters.syncs, counters.syncs_missed));
    }
  }

 private:
  struct Report {
    Cia402Counters counters;
    std::vector<Cia402NodeStatus> nodes;
  };

  bool send(const CanFrame& frame) override { return host_->send(frame); }
  void sample(const JointSample& sample) override { host_->push(sample); }
  void event(const Cia402Event& event) override {
    host_->note(severity_of(event.kind), log_kind(event.kind), event.text);
  }

  CanProtocolHost* host_;
  Cia402Session session_;
  Latest<Report> published_;
};

}  // namespace

void check_stream(const Cia402StreamConfig& config, Diagnostics& diagnostics) {
  Cia402StreamConfig sound = config;
  sound.nodes.clear();
  for (const Cia402NodeConfig& node : config.nodes) {
    const bool twice = std::ranges::any_of(sound.nodes, [&](const Cia402NodeConfig& other) {
      return other.node_id == node.node_id || other.joint == node.joint;
    });
    if (node.node_id > 0 && !node.joint_name.empty() && !twice) sound.nodes.push_back(node);
  }
  check_channel(config.channel, config.place, diagnostics);
  if (!sound.nodes.empty()) static_cast<void>(plan_cia402(sound, diagnostics));
}

Result<std::unique_ptr<JointStream>> make_cia402_stream(const Cia402StreamConfig& config, const Clock& clock,
                                                        CanStreamOptions options) {
  Diagnostics diagnostics;
  auto plan = plan_cia402(config, diagnostics);
  if (!plan) return fail("the CiA 402 stream cannot be set up:\n" + diagnostics.text());
  return std::make_unique<CanStream>("can-cia402",
                                     std::make_shared<SharedChannel>(config.channel, clock, std::move(options)), clock,
                                     [plan = std::move(*plan)](CanProtocolHost& host) -> std::unique_ptr<CanProtocol> {
                                       return std::make_unique<Cia402Protocol>(plan, host);
                                     });
}

}  // namespace cellmirror::can
