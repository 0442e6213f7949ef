// A CANopen device as it answers on the bus (CiA 301): NMT, boot-up, heartbeat, node guarding, SDO server, PDOs, SYNC,
// EMCY, layer setting services, and the heartbeat of its master. Its application has the objects' meaning. No I/O, no
// clock.
#pragma once

#include <cstdint>
#include <deque>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/canopen/fault_gate.hpp"
#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/canopen/lss.hpp"
#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo_server.hpp"
#include "drivers/can/canopen/slave_pdos.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::can {

// What a slave tells its application, and asks it.
class SlaveApplication : public PdoEvents {
 public:
  // Why a write by SDO that fits type, access and limits is refused all the same; none: it is not.
  [[nodiscard]] virtual std::optional<SdoAbort> check(ObjectAddress address, std::int64_t value) = 0;
  // Objects that one SDO or one PDO has just written, in the order of the PDO.
  virtual void written(std::span<const ObjectAddress> addresses, Timestamp now) = 0;
  // NMT reset node or power-on: all objects have their values of power-on again.
  virtual void on_reset(Timestamp now) = 0;
  // Returns true if object 0x1010 stores the object: parameters, but not commands and targets.
  [[nodiscard]] virtual bool is_stored(ObjectAddress /*address*/) const { return true; }
  // A SYNC: its TPDOs are sent, its RPDOs are written.
  virtual void synced(Timestamp now) = 0;
  // The master's heartbeat or guarding ended, or the master stopped this node or reset its communication. Returns true
  // if the device enters a fault, which lasts until emergency(0, ...) even if communication returns.
  virtual bool communication_lost(Timestamp now) = 0;
  // A fault was injected: the device fails with this error. False: it only reports the error.
  virtual bool fail(std::uint16_t /*code*/, std::uint8_t /*error_register*/, Timestamp /*now*/) { return false; }
};

// Objects 0x1000 to 0x1029 that the slave serves itself, beside the PDOs' (slave_pdos.hpp).
struct SlaveIdentity {
  std::uint32_t device_type = 0;   // object 0x1000
  std::string name;                // object 0x1008; 0x1009 and 0x100A are constants of the simulation
  std::uint16_t heartbeat_ms = 0;  // object 0x1017 at power-on; 0: none until it is written
};
void add_communication_objects(ObjectDictionary& objects, std::uint8_t node, const SlaveIdentity& identity);

class CanopenSlave final : private SdoObjects {
 public:
  // `node` 1..127. `defaults`: the objects at power-on, with those of add_communication_objects() and
  // add_pdo_objects(). `event`: slave_pdos.hpp. The references outlive the slave. Off until power_on().
  CanopenSlave(std::uint8_t node, ObjectDictionary defaults, ObjectAddress event, SlaveApplication& application,
               FrameOutput& output);

  // Before power_on(): has no number until a master gives it one by LSS (CiA 305), and says nothing until then; again
  // after NMT reset node. The serial number stays that of the objects.
  void wait_for_number();
  // Boot-up message, then `first`: pre-operational, or operational without being told.
  void power_on(NmtState first, Timestamp now);
  void power_off();  // silent and deaf

  void receive(const CanFrame& frame, Timestamp now);
  // The 11-bit identifiers of the frames that it takes, added to `identifiers`; others need not be given to it.
  void list_identifiers(std::vector<std::uint32_t>& identifiers) const;
  // Grows wherever they may have changed.
  [[nodiscard]] std::uint64_t identifiers_revision() const { return identifiers_revision_; }
  void advance(Timestamp now);               // timers; call at next_due() or more often
  [[nodiscard]] Timestamp next_due() const;  // "never" while nothing is timed
  // The application has changed values of objects.
  void changed(Timestamp now);
  // Reports a device error: EMCY, error register (0x1001) and list of errors (0x1003). `code` 0: the error is reset.
  // The slave itself reports and clears communication errors (heartbeat, guarding, lengths, late RPDOs).
  void emergency(std::uint16_t code, std::uint8_t error_register);

  // A fault of this node from now on, at most FaultGate::kMostFaults at a time. Without power (death) it is deaf and
  // silent, as after a reset, and boots in the end.
  void inject(const NodeFault& fault, Timestamp now);
  void end_faults(Timestamp now);
  [[nodiscard]] const FaultGate& faults() const { return gate_; }

  [[nodiscard]] std::uint8_t node() const { return node_; }  // a master may change it by LSS; kNoNodeNumber
  [[nodiscard]] bool is_powered() const { return powered_; }
  [[nodiscard]] NmtState state() const { return nmt_; }
  [[nodiscard]] ObjectDictionary& objects() { return objects_; }
  [[nodiscard]] const ObjectDictionary& objects() const { return objects_; }

 private:
  // SdoObjects
  [[nodiscard]] std::expected<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) override;
  [[nodiscard]] std::optional<SdoAbort> write(ObjectAddress address, std::span<const std::uint8_t> value) override;
  [[nodiscard]] std::optional<SdoAbort> refuse(ObjectAddress address, std::int64_t value);

  enum class ResetKind : std::uint8_t { communication, node };
  // `communication` resets objects 0x1000 to 0x1FFF, `node` all objects.
  void reset(ResetKind kind, Timestamp now);
  void reset_objects(ResetKind kind);
  void follow_faults(Timestamp now);
  // The node's number, and the identifiers at power-on that follow from it.
  void renumber(std::uint8_t node);
  [[nodiscard]] LssSlave::Identity identity() const;
  void on_nmt(NmtCommand command, Timestamp now);
  void enter(NmtState state, Timestamp now);
  void on_lss(const CanFrame& frame, Timestamp now);
  void on_sync(const CanFrame& frame, Timestamp now);
  void on_request(const CanFrame& frame, Timestamp now);
  void on_guarding(Timestamp now);
  void on_heartbeat(const Heartbeat& heartbeat, Timestamp now);
  void on_rpdo(const CanFrame& frame, Timestamp now);
  void after_write(std::span<const ObjectAddress> addresses, Timestamp now);
  void restart_heartbeat(Timestamp now);
  // Communication errors as bits; object 0x1001 shows them until they are cleared.
  enum CommunicationError : std::uint8_t {
    heartbeat_lost = 1,
    guarding_lost = 2,
    wrong_pdo_length = 4,
    wrong_sync_length = 8,
    rpdo_late = 16,
  };
  void set_error(CommunicationError error, std::uint16_t code);
  void clear_error(CommunicationError error);
  [[nodiscard]] std::uint8_t error_register() const;
  void report(std::uint16_t code);  // sends EMCY with the current error register
  [[nodiscard]] Timestamp next_emergency() const;
  void master_lost(CommunicationError error, Timestamp now);
  [[nodiscard]] std::optional<SdoAbort> store(ObjectAddress address, std::span<const std::uint8_t> value);
  void drain_server(Timestamp now);
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t subindex = 0) const;

  std::uint8_t node_;
  std::uint8_t first_node_;  // at power-on, and after NMT reset node
  LssSlave lss_;
  SlaveApplication* application_;
  FaultGate gate_;             // what is sent goes through it
  ObjectDictionary defaults_;  // values at power-on: factory_ with the parameters that a master has stored
  ObjectDictionary factory_;
  ObjectDictionary objects_;
  SdoServer server_;
  SlavePdos pdos_;
  std::uint64_t identifiers_revision_ = 0;
  bool powered_ = false;
  NmtState nmt_ = NmtState::boot_up;
  NmtState first_ = NmtState::pre_operational;
  bool guard_toggle_ = false;
  bool restores_ = false;  // the next NMT reset node restores the values of factory_
  std::uint8_t communication_errors_ = 0;
  std::uint8_t device_errors_ = 0;    // error register of the application
  std::deque<CanFrame> emergencies_;  // waiting for the inhibit time (0x1015)
  Timestamp emergency_sent_;
  bool reports_error_ = false;          // an injected one that the application leaves to this
  Timestamp now_;                       // of the call under way, for writes that come through the SDO server
  Timestamp heartbeat_due_;             // of our own
  Timestamp master_due_;                // of the master's, once it was heard; never: it is not watched
  Timestamp guard_due_;                 // the same for node guarding
  std::vector<ObjectAddress> written_;  // by the PDO under way
};

}  // namespace cellmirror::can
