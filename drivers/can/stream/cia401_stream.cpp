#include <fmt/format.h>

#include <memory>
#include <utility>
#include <vector>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/earlier_due.hpp"
#include "drivers/can/cia401/io_node.hpp"
#include "drivers/can/stream/can_stream.hpp"
#include "drivers/can/stream/fault_orders.hpp"
#include "drivers/can/stream/node_output.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {
namespace {

class Cia401Protocol final : public CanProtocol {
 public:
  Cia401Protocol(const IoNodeConfig& config, IoLinks links, CanProtocolHost& host)
      : period_(config.period),
        links_(std::move(links)),
        output_(host, 0),
        node_(config.node_id, config.heartbeat_ms, output_) {
    if (config.waits_for_lss) node_.wait_for_number();
  }

  void start(Timestamp now) override {
    forget_orders(links_.faults.get());
    due_ = now + period_;
    node_.set_inputs(links_.inputs->read().value, now);
    node_.power_on(now);
    give_outputs();
  }

  void receive(const CanFrame& frame, Timestamp now, std::size_t /*node*/) override {
    node_.receive(frame, now);
    give_outputs();
  }

  void advance(Timestamp now) override {
    NodeFaultOrder order;
    while (links_.faults && links_.faults->pop(order)) carry_out(order, node_, now);
    node_.set_inputs(links_.inputs->read().value, now);
    node_.advance(now);
    give_outputs();
    if (now < due_) return;
    due_ = due_ + period_;
    if (due_ <= now) due_ = now + period_;
  }

  [[nodiscard]] Timestamp next_due() const override { return earlier_due(due_, node_.next_timer()); }

  void publish() override {
    published_.write({node_.nmt_state(), links_.inputs->read().value, node_.outputs(), node_.faults().kinds()});
  }

  void describe(JointStreamStatus& status, Timestamp /*now*/) override {
    const Report& report = published_.read().value;
    status.condition = fmt::format("answers as an I/O node: {}", words(report.nmt));
    status.details.emplace_back("inputs", fmt::format("0x{:08X}", report.inputs.digital));
    status.details.emplace_back("outputs", fmt::format("0x{:08X}", report.outputs.digital));
    if (report.faults != 0) status.details.emplace_back("injected faults", fault_words(report.faults));
  }

  void add_routes(std::uint16_t member, IdentifierRoutes& routes) const override {
    std::vector<std::uint32_t> identifiers;
    node_.list_identifiers(identifiers);
    routes.add({member, 0}, identifiers);
  }

  [[nodiscard]] std::uint64_t routes_revision() const override { return node_.identifiers_revision(); }

 private:
  struct Report {
    NmtState nmt = NmtState::boot_up;
    IoInputs inputs;
    IoOutputs outputs;
    std::uint8_t faults = 0;
  };

  void give_outputs() {
    if (std::exchange(given_, node_.outputs().digital) == node_.outputs().digital) return;
    links_.outputs->write(node_.outputs());
    if (links_.outputs_changed) links_.outputs_changed();
  }

  Nanoseconds period_;
  IoLinks links_;
  NodeOutput output_;
  IoNode node_;
  Timestamp due_;
  std::uint32_t given_ = 0;
  Latest<Report> published_;
};

// An I/O node has no joints.
class NoSamples final : public JointSampleSink {
 public:
  bool push(const JointSample& /*sample*/) noexcept override { return true; }
};

}  // namespace

JointSampleSink& no_samples() {
  static NoSamples none;
  return none;
}

std::unique_ptr<JointStream> make_cia401_node(const IoNodeConfig& config, IoLinks links, const Clock& clock,
                                              std::shared_ptr<SharedChannel> channel) {
  CELLMIRROR_EXPECTS(config.node_id >= 1 && config.node_id <= kMaxNodeId && links.inputs && links.outputs);
  return std::make_unique<CanStream>(
      "cia401-node", std::move(channel), clock,
      [config, links = std::move(links)](CanProtocolHost& host) -> std::unique_ptr<CanProtocol> {
        return std::make_unique<Cia401Protocol>(config, links, host);
      });
}

}  // namespace cellmirror::can
