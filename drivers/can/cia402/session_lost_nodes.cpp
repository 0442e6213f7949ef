// Nodes that are lost are asked by SDO now and then. A drive that was off while its boot-up could not be heard is
// pre-operational and as its maker made it: it may send nothing by itself (object 0x1017 is 0), but answers SDO. One
// that was stopped does not answer (CiA 301, 7.3.2.2.4), so that it is left stopped.
#include <algorithm>
#include <span>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/cia402/session.hpp"

namespace cellmirror::can {
namespace {

constexpr ObjectAddress kDeviceType{0x1000, 0};  // every device has it

bool is_cob_id(ObjectAddress address) {
  return address.index >= 0x1800 && address.index < 0x1A00 && address.subindex == 1;
}

}  // namespace

// A stream that only listens asks nobody.
bool Cia402Session::asks_lost_nodes(const Node& node) const {
  return plan_.config.heartbeat_timeout.count() > 0 && (plan_.config.start_nodes || !node.steps.empty());
}

// A node that was configured to send its heartbeat and does not is lost, whatever else it sends.
bool Cia402Session::is_silent(const Node& node, Timestamp now) const {
  if (!node.steps.empty() && plan_.config.heartbeat_producer_ms > 0) return true;
  return !node.status.last_tpdo.known() || now - node.status.last_tpdo >= plan_.config.heartbeat_timeout;
}

void Cia402Session::ask(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  node.ask = now + kAskLost;
  const bool busy = node.status.configuring || node.retry.known() || node.sdo->state() == SdoClient::State::busy;
  if (busy || !is_silent(node, now)) return;
  node.asking = true;
  node.step = node.steps.size();
  if (node.steps.empty()) {
    output_->send(node.sdo->upload(kDeviceType, now));
  } else {
    ask_for_step(index, now);
  }
}

// Reads back what was written, the last of it first: that is the heartbeat, which a reset switches off.
void Cia402Session::ask_for_step(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  while (node.step > 0 && !is_last_write(node, node.step - 1)) --node.step;
  if (node.step == 0) {
    node.asking = false;
    start_node(node, now);
    return;
  }
  --node.step;
  output_->send(node.sdo->upload(node.steps[node.step].address, now));
}

bool Cia402Session::is_last_write(const Node& node, std::size_t step) {
  const auto later = std::span(node.steps).subspan(step + 1);
  return std::ranges::none_of(
      later, [&](const ConfigurationStep& other) { return other.address == node.steps[step].address; });
}

bool Cia402Session::kept(const Node& node) {
  const ConfigurationStep& step = node.steps[node.step];
  if (node.sdo->state() != SdoClient::State::done) return step.optional;
  const std::size_t bytes = std::min<std::size_t>(step.bytes, node.sdo->value().size());
  std::uint32_t differs = static_cast<std::uint32_t>(get_le(node.sdo->value(), bytes)) ^ step.value;
  if (is_cob_id(step.address)) differs &= ~kCobIdNoRtr;  // some drives do not keep it
  return differs == 0;
}

void Cia402Session::on_asked(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  if (node.sdo->state() == SdoClient::State::busy) return;
  if (node.sdo->state() == SdoClient::State::failed && node.sdo->abort() == SdoAbort::timed_out) {
    node.asking = false;
    return;
  }
  node.status.heard = true;
  if (node.steps.empty()) {
    node.asking = false;
    start_node(node, now);
  } else if (kept(node)) {
    ask_for_step(index, now);
  } else {
    on_forgotten(index, now);
  }
}

void Cia402Session::on_forgotten(std::size_t index, Timestamp now) {
  Node& node = nodes_[index];
  node.status.state = Cia402State::unknown;
  node.status.statusword = 0;
  node.configured = false;
  report(Cia402EventKind::boot_up, index, "answers, but not as it was configured: its boot-up was missed");
  bring_up(index, now);
}

}  // namespace cellmirror::can
