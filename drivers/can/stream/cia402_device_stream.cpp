#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/earlier_due.hpp"
#include "drivers/can/canopen/emcy.hpp"
#include "drivers/can/cia402/device/contact_bounds.hpp"
#include "drivers/can/cia402/device/servo_drive.hpp"
#include "drivers/can/stream/can_stream.hpp"
#include "drivers/can/stream/fault_orders.hpp"
#include "drivers/can/stream/node_output.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {
namespace {

// The drives of one robot on one channel.
class Cia402DeviceProtocol final : public CanProtocol {
 public:
  // `nodes` keeps where the joints are for the next time that the stream is opened.
  Cia402DeviceProtocol(const Cia402DeviceConfig& config, std::shared_ptr<std::vector<DriveConfig>> nodes,
                       std::shared_ptr<Latest<RobotContacts>> contacts, std::shared_ptr<NodeFaultInlet> faults,
                       CanProtocolHost& host)
      : period_(config.period),
        nodes_(std::move(nodes)),
        contacts_(std::move(contacts)),
        faults_(std::move(faults)),
        host_(&host) {
    for (const DriveConfig& node : *nodes_) {
      outputs_.push_back(std::make_unique<NodeOutput>(host, drives_.size()));
      drives_.push_back(std::make_unique<ServoDrive>(node, config.heartbeat_ms, *outputs_.back()));
    }
    errors_.resize(drives_.size());
  }

  void start(Timestamp now) override {
    forget_orders(faults_.get());
    due_ = now + period_;
    for (const auto& drive : drives_) drive->power_on(now);
  }

  void receive(const CanFrame& frame, Timestamp now, std::size_t node) override {
    // Once where several drives take the frame.
    if (std::exchange(contacts_applied_, now) != now) apply_contacts();
    drives_[node]->receive(frame, now);
  }

  void advance(Timestamp now) override {
    take_faults(now);
    apply_contacts();
    for (const auto& drive : drives_) drive->advance(now);
    note_errors(now);
    if (now < due_) return;
    due_ = due_ + period_;
    if (due_ <= now) due_ = now + period_;
    push_sample(now);
  }

  [[nodiscard]] Timestamp next_due() const override {
    Timestamp due = due_;
    for (const auto& drive : drives_) due = earlier_due(due, drive->next_timer());
    return due;
  }

  void publish() override {
    Report& report = published_.writable();
    report.samples = sequence_;
    report.drives.clear();
    for (const auto& drive : drives_)
      report.drives.push_back({drive->node_id(), drive->nmt_state(), drive->state(), drive->mode(), drive->error_code(),
                               drive->is_held_back(), drive->faults().kinds()});
    published_.publish();
  }

  void describe(JointStreamStatus& status, Timestamp /*now*/) override {
    const Report& report = published_.read().value;
    status.received = report.samples;
    std::size_t operational = 0;
    std::size_t enabled = 0;
    for (std::size_t i = 0; i < report.drives.size(); ++i) {
      const DriveReport& drive = report.drives[i];
      const DriveConfig& node = (*nodes_)[i];
      operational += drive.nmt == NmtState::operational ? 1U : 0U;
      enabled += drive.state == Cia402State::operation_enabled ? 1U : 0U;
      std::string text = fmt::format("{}, {}, {}", words(drive.nmt), words(drive.state), words(drive.mode));
      if (drive.held_back) text += ", blocked by what it touches";
      if (drive.error != 0) text += fmt::format(", 0x{:04X} {}", drive.error, emcy_words(drive.error));
      if (drive.faults != 0) text += fmt::format(", injected: {}", fault_words(drive.faults));
      status.details.emplace_back(fmt::format("node {} ({})", drive.node, node.joint_name), std::move(text));
    }
    status.condition = fmt::format("answers as {} {}: {} operational, {} enabled", report.drives.size(),
                                   report.drives.size() == 1 ? "drive" : "drives", operational, enabled);
  }

  void add_routes(std::uint16_t member, IdentifierRoutes& routes) const override {
    std::vector<std::uint32_t> identifiers;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      identifiers.clear();
      drives_[i]->list_identifiers(identifiers);
      routes.add({member, static_cast<std::uint16_t>(i)}, identifiers);
    }
  }

  // Each drive's number only grows.
  [[nodiscard]] std::uint64_t routes_revision() const override {
    std::uint64_t sum = 0;
    for (const auto& drive : drives_) sum += drive->identifiers_revision();
    return sum;
  }

 private:
  struct DriveReport {
    std::uint8_t node = 0;
    NmtState nmt = NmtState::boot_up;
    Cia402State state = Cia402State::unknown;
    DriveMode mode = DriveMode::none;
    std::uint16_t error = 0;
    bool held_back = false;
    std::uint8_t faults = 0;
  };
  struct Report {
    std::uint64_t samples = 0;
    std::vector<DriveReport> drives;
  };

  void take_faults(Timestamp now) {
    NodeFaultOrder order;
    while (faults_ && faults_->pop(order)) {
      for (std::size_t i = 0; i < drives_.size(); ++i) {
        if ((*nodes_)[i].node_id == order.node) carry_out(order, *drives_[i], now);
      }
    }
  }

  void apply_contacts() {
    if (!contacts_) return;
    const RobotContacts& contacts = contacts_->read().value;
    if (contacts.count == 0 && !touching_) return;
    if (!std::exchange(touching_, contacts.count > 0)) touched_ = contacts.posture_time;
    JointVelocities velocities{};
    for (std::size_t i = 0; i < drives_.size(); ++i) velocities.at((*nodes_)[i].joint) = drives_[i]->joint_velocity();
    const JointBounds bounds = contact_bounds(contacts, velocities);
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i]->set_bounds(bounds.at((*nodes_)[i].joint));
  }

  void note_errors(Timestamp now) {
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      const std::uint16_t code = drives_[i]->error_code();
      if (std::exchange(errors_[i], code) == code || code == 0) continue;
      const DriveConfig& node = (*nodes_)[i];
      std::string text =
          fmt::format("drive {} ({}): 0x{:04X} {}", drives_[i]->node_id(), node.joint_name, code, emcy_words(code));
      if (touching_) text += fmt::format(", {:.1f} ms after the robot touched", 1e3 * seconds(now - touched_));
      host_->note(Severity::warning, "device fault", text);
    }
  }

  void push_sample(Timestamp now) {
    JointSample sample;
    sample.receive_time = now;
    sample.source_time = now;
    sample.sequence = ++sequence_;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      const ServoDrive& drive = *drives_[i];
      DriveConfig& node = (*nodes_)[i];
      sample.present |= 1U << node.joint;
      sample.position.at(node.joint) = drive.joint_position();
      sample.velocity.at(node.joint) = drive.joint_velocity();
      sample.effort.at(node.joint) = drive.joint_torque();
      node.start = drive.joint_position();
    }
    host_->push(sample);
  }

  Nanoseconds period_;
  std::shared_ptr<std::vector<DriveConfig>> nodes_;
  std::shared_ptr<Latest<RobotContacts>> contacts_;  // may be null
  std::shared_ptr<NodeFaultInlet> faults_;           // likewise
  bool touching_ = false;                            // the drives have bounds
  Timestamp touched_;                                // the first posture of the contact that they have them for
  Timestamp contacts_applied_;                       // the frame before which they were looked at
  CanProtocolHost* host_;
  std::vector<std::unique_ptr<NodeOutput>> outputs_;  // of the drives
  std::vector<std::unique_ptr<ServoDrive>> drives_;
  std::vector<std::uint16_t> errors_;  // that were noted
  Timestamp due_;                      // of the next sample
  std::uint64_t sequence_ = 0;
  Latest<Report> published_;
};

}  // namespace

Result<std::unique_ptr<JointStream>> make_cia402_device(const Cia402DeviceConfig& config, const Clock& clock,
                                                        std::shared_ptr<SharedChannel> channel,
                                                        std::shared_ptr<Latest<RobotContacts>> contacts,
                                                        std::shared_ptr<NodeFaultInlet> faults) {
  if (config.nodes.empty()) return fail("the device has no drives", "add [[device.node]] with id and joint");
  for (const DriveConfig& node : config.nodes) {
    CELLMIRROR_EXPECTS(node.node_id >= 1 && node.node_id <= kMaxNodeId && node.joint < kMaxJointsPerRobot);
    CELLMIRROR_EXPECTS(node.increments_per_unit() > 0 && node.inertia > 0 && node.rated_torque > 0);
  }
  auto nodes = std::make_shared<std::vector<DriveConfig>>(config.nodes);
  return std::make_unique<CanStream>(
      "cia402-device", std::move(channel), clock,
      [config, nodes, contacts = std::move(contacts),
       faults = std::move(faults)](CanProtocolHost& host) -> std::unique_ptr<CanProtocol> {
        return std::make_unique<Cia402DeviceProtocol>(config, nodes, contacts, faults, host);
      });
}

}  // namespace cellmirror::can
