// The life of a node as the mirror sees it: boot-up, configuration by SDO, NMT start, heartbeat, EMCY.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/cia402/session.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kStartAgain = 1s;    // a node that stays pre-operational is started again this often
constexpr Nanoseconds kRetrySilent = 1s;   // configuration of a node that did not answer
constexpr Nanoseconds kRetryRefused = 5s;  // configuration that a node refused
constexpr std::uint32_t kProducerHeartbeat = 0x1017;

std::uint32_t configured_word(const PdoEntryConfig& entry) {
  PdoEntryConfig mapped = entry;
  if (entry.index == 0) {
    // Filler bits are mapped as the data type of their size (CiA 301, 7.4.8.3).
    mapped.index = entry.bits == 1 ? 0x0001 : entry.bits == 8 ? 0x0005 : entry.bits == 16 ? 0x0006 : 0x0007;
  }
  return mapping_word(mapped);
}

}  // namespace

std::vector<Cia402Session::ConfigurationStep> Cia402Session::steps_of(const Cia402Plan& plan,
                                                                      const Cia402NodePlan& node) {
  std::vector<ConfigurationStep> steps;
  for (const TpdoConfig& tpdo : node.tpdos) {
    const auto parameters = static_cast<std::uint16_t>(0x1800 + tpdo.number - 1);
    const auto mapping = static_cast<std::uint16_t>(0x1A00 + tpdo.number - 1);
    const std::uint32_t cob_id = tpdo.cob_id | kCobIdNoRtr;
    steps.push_back({{parameters, 1}, cob_id | kCobIdInvalid, 4});
    steps.push_back({{mapping, 0}, 0, 1});
    for (std::size_t i = 0; i < tpdo.entries.size(); ++i) {
      steps.push_back({{mapping, static_cast<std::uint8_t>(i + 1)}, configured_word(tpdo.entries[i]), 4});
    }
    steps.push_back({{mapping, 0}, static_cast<std::uint32_t>(tpdo.entries.size()), 1});
    steps.push_back({{parameters, 2}, tpdo.transmission_type, 1});
    steps.push_back({{parameters, 3}, tpdo.inhibit_time_100us, 2, tpdo.inhibit_time_100us == 0});
    steps.push_back({{parameters, 5}, tpdo.event_timer_ms, 2, tpdo.event_timer_ms == 0});
    steps.push_back({{parameters, 1}, cob_id, 4});
  }
  if (plan.config.heartbeat_producer_ms > 0) {
    steps.push_back({{kProducerHeartbeat, 0}, plan.config.heartbeat_producer_ms, 2});
  }
  return steps;
}

void Cia402Session::bring_up(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  node.retry = {};
  node.counter.reset();  // the drive may have been homed again
  if (!node.steps.empty() && !node.configured) {
    begin_configuration(index, now);
  } else {
    start_node(node, now);
  }
}

void Cia402Session::start_node(Node& node, Timestamp now) {
  if (!plan_.config.start_nodes) return;
  node.start_sent = now;
  output_->send(encode_nmt({NmtCommand::start, node.status.node_id}));
}

void Cia402Session::begin_configuration(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  output_->send(encode_nmt({NmtCommand::enter_pre_operational, node.status.node_id}));
  node.status.configuring = true;
  node.answering = false;
  node.step = 0;
  node.asking = false;
  node.sdo->reset();
  next_step(index, now);
}

void Cia402Session::next_step(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  if (node.step == node.steps.size()) {
    node.configured = true;
    node.status.configuring = false;
    node.status.configuration_error.clear();
    report(Cia402EventKind::configured, index, "configured");
    start_node(node, now);
    return;
  }
  const ConfigurationStep& step = node.steps[node.step];
  std::array<std::uint8_t, 4> value{};
  put_le(value, step.value, step.bytes);
  output_->send(node.sdo->download(step.address, std::span(value).first(step.bytes), now));
}

void Cia402Session::on_sdo_progress(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  if (node.asking) return on_asked(index, now);
  if (!node.status.configuring) return;
  if (node.sdo->state() == SdoClient::State::done) {
    node.status.heard = true;
    ++node.step;
    next_step(index, now);
    return;
  }
  if (node.sdo->state() != SdoClient::State::failed) return;
  const SdoAbort abort = node.sdo->abort();
  const bool lacks_object = abort == SdoAbort::no_such_object || abort == SdoAbort::no_such_subindex;
  const ConfigurationStep& step = node.steps[node.step];
  if (step.optional && lacks_object) {
    ++node.step;
    next_step(index, now);
    return;
  }
  const std::string why = abort == SdoAbort::timed_out
                              ? fmt::format("no answer to the SDO write of {}", text(step.address))
                              : fmt::format("the SDO write of {} was refused: 0x{:08X} {}", text(step.address),
                                            static_cast<std::uint32_t>(abort), words(abort));
  fail_configuration(index, why, now);
}

void Cia402Session::fail_configuration(std::size_t index, const std::string& why, Timestamp now) {
  Node& node = nodes_[index];
  node.status.configuring = false;
  const bool silent = node.sdo->abort() == SdoAbort::timed_out;
  node.retry = now + (silent ? kRetrySilent : kRetryRefused);
  if (node.status.configuration_error != why) report(Cia402EventKind::configuration_failed, index, why);
  node.status.configuration_error = why;
}

void Cia402Session::on_heartbeat(std::size_t index, NmtState state, Timestamp now) {
  Node& node = nodes_[index];
  node.status.heard = true;
  node.status.last_heartbeat = now;
  if (state == NmtState::boot_up) node.cadence.restart();
  const bool doubled = state != NmtState::boot_up && node.cadence.take(now);
  if (doubled && !node.status.doubled_heartbeats)
    report(Cia402EventKind::second_drive, index,
           "heartbeats come twice as often as before: perhaps a second drive has its id");
  node.status.doubled_heartbeats = doubled;
  // Its boot-up may have been missed, while the bus was off for instance, and a reset forgets what SDO wrote.
  const bool was_away = node.status.heartbeat_lost || node.status.nmt == NmtState::operational;
  if (state == NmtState::pre_operational && was_away && !node.status.configuring) node.configured = false;
  if (state != NmtState::boot_up) node.was_operational = state == NmtState::operational;
  node.status.nmt = state;
  if (plan_.config.heartbeat_timeout.count() > 0) node.heartbeat_deadline = now + plan_.config.heartbeat_timeout;
  if (node.status.heartbeat_lost) {
    node.status.heartbeat_lost = false;
    node.ask = {};
    if (std::exchange(node.asking, false)) node.sdo->reset();
    report(Cia402EventKind::node_resolved, index, "the heartbeat is back");
  }
  if (state == NmtState::boot_up) {
    on_boot_up(index, now);
    return;
  }
  if (state != NmtState::operational) node.answering = false;
  // A stopped node was stopped on purpose; a node that missed its start stays pre-operational.
  const bool waits = state == NmtState::pre_operational && !node.status.configuring && !node.retry.known();
  if (waits && now - node.start_sent >= kStartAgain) bring_up(index, now);
}

void Cia402Session::on_boot_up(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  ++node.status.boot_ups;
  const bool was_operational = std::exchange(node.was_operational, false);
  node.status.state = Cia402State::unknown;
  node.status.statusword = 0;
  node.answering = false;
  node.configured = false;  // a reset forgets what SDO wrote
  report(Cia402EventKind::boot_up, index,
         was_operational ? "boot-up while it was operational: it was reset, or a second drive has its id" : "boot-up");
  bring_up(index, now);
}

void Cia402Session::on_emcy(std::size_t index, const Emcy& emcy) {
  Node& node = nodes_[index];
  node.status.heard = true;
  node.status.last_emcy = emcy;
  report(Cia402EventKind::emcy, index, "EMCY " + text(emcy));
}

void Cia402Session::watch(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  if (!node.heartbeat_deadline.known() || now < node.heartbeat_deadline) return;
  node.heartbeat_deadline = {};
  node.status.heartbeat_lost = true;
  node.was_operational = false;
  node.status.nmt.reset();
  node.answering = false;
  if (asks_lost_nodes(node)) node.ask = now + kAskLost;
  report(Cia402EventKind::node_lost, index, node.status.last_heartbeat.known() ? "no heartbeat" : "not heard");
}

std::string conflict_text(const Cia402NodeStatus& node) {
  return fmt::format("two drives answer: near {:.4g} and {:.4g} rad or m", node.places.a, node.places.b);
}

namespace {

bool is_in_conflict(const Cia402NodeStatus& node, Timestamp now) {
  return node.in_conflict && now - node.last_conflict <= AlternationWatch::kWindow;
}

}  // namespace

std::string words(const Cia402NodeStatus& node, Timestamp now) {
  if (is_in_conflict(node, now)) return conflict_text(node);
  if (!node.configuration_error.empty()) return "configuration failed: " + node.configuration_error;
  if (node.configuring) return "being configured";
  if (node.heartbeat_lost && node.last_heartbeat.known()) {
    return fmt::format("no heartbeat since {:.1f} s", seconds(now - node.last_heartbeat));
  }
  if (!node.heard) return "not heard yet";
  if (node.heartbeat_lost) return fmt::format("sends no heartbeat (object 0x1017), {}", words(node.state));
  const std::string nmt = node.nmt ? std::string(words(*node.nmt)) : "NMT state unknown";
  return fmt::format("{}, {}{}", nmt, words(node.state), node.doubled_heartbeats ? ", heartbeats twice as often" : "");
}

std::string condition(const std::vector<Cia402NodeStatus>& nodes, Timestamp now) {
  constexpr std::size_t kShown = 3;
  std::string text;
  std::size_t wrong = 0;
  for (const Cia402NodeStatus& node : nodes) {
    const bool works = !is_in_conflict(node, now) && node.configuration_error.empty() && !node.configuring &&
                       node.heard && !node.heartbeat_lost && (!node.nmt || *node.nmt == NmtState::operational);
    const bool fault = node.state == Cia402State::fault || node.state == Cia402State::fault_reaction_active;
    if (works && !fault) continue;
    if (++wrong > kShown) continue;
    if (!text.empty()) text += "; ";
    text += fmt::format("node {} ({}): {}", node.node_id, node.joint_name, words(node, now));
  }
  if (wrong == 0) return "operational";
  return wrong > kShown ? fmt::format("{}; and {} nodes more", text, wrong - kShown) : text;
}

}  // namespace cellmirror::can
