// A CiA 401 I/O node of a CAN bus: digital inputs and outputs, analogue inputs. CANopen by canopen/slave.hpp. No I/O,
// no clock: frames, inputs and time are pushed in, frames and outputs come out. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/canopen/slave.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/io_image.hpp"

namespace cellmirror::can {

class IoNode final : private SlaveApplication {
 public:
  // `node_id` 1..127; `output` outlives the node. Off until power_on().
  IoNode(std::uint8_t node_id, std::uint16_t heartbeat_ms, FrameOutput& output);

  // Before power_on(): slave.hpp.
  void wait_for_number() { slave_.wait_for_number(); }
  void power_on(Timestamp now);  // boot-up message, then NMT pre-operational
  void receive(const CanFrame& frame, Timestamp now);
  // As those of CanopenSlave.
  void list_identifiers(std::vector<std::uint32_t>& identifiers) const { slave_.list_identifiers(identifiers); }
  [[nodiscard]] std::uint64_t identifiers_revision() const { return slave_.identifiers_revision(); }
  void advance(Timestamp now) { slave_.advance(now); }
  [[nodiscard]] Timestamp next_timer() const { return slave_.next_due(); }

  // Faults: slave.hpp. Inputs that are stuck are so from the next set_inputs() on.
  void inject(const NodeFault& fault, Timestamp now) { slave_.inject(fault, now); }
  void end_faults(Timestamp now) { slave_.end_faults(now); }
  [[nodiscard]] const FaultGate& faults() const { return slave_.faults(); }

  // TPDOs of events are sent at once, as the interrupt objects allow.
  void set_inputs(const IoInputs& real, Timestamp now);
  // Where the master is lost or has stopped the node, outputs have their error values (0x6206, 0x6207).
  [[nodiscard]] const IoOutputs& outputs() const { return outputs_; }

  [[nodiscard]] std::uint8_t node_id() const { return slave_.node(); }
  [[nodiscard]] NmtState nmt_state() const { return slave_.state(); }
  [[nodiscard]] const ObjectDictionary& objects() const { return slave_.objects(); }

 private:
  // SlaveApplication
  [[nodiscard]] std::optional<SdoAbort> check(ObjectAddress address, std::int64_t value) override;
  void written(std::span<const ObjectAddress> addresses, Timestamp now) override;
  void on_reset(Timestamp now) override;
  void synced(Timestamp now) override;
  bool communication_lost(Timestamp now) override;
  [[nodiscard]] bool is_stored(ObjectAddress address) const override;
  [[nodiscard]] bool is_event(ObjectAddress address, std::uint64_t sent, std::uint64_t now) const override;

  void write_inputs();
  // The objects of an array of bytes as one number.
  [[nodiscard]] std::uint32_t bits(std::uint16_t index) const;
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t subindex) const;

  CanopenSlave slave_;
  IoInputs inputs_;
  IoOutputs outputs_;
};

}  // namespace cellmirror::can
