// A CiA 402 drive as it answers on the bus: NMT, SDO server, PDOs, SYNC, heartbeat, EMCY and the power state machine.
// Protocol only, without I/O and without a clock: frames and time are pushed in, frames come out. Simulators use it,
// and a robot of the cell that answers a real controller (hardware in the loop) will.
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo_server.hpp"
#include "drivers/can/cia402/state.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

struct Cia402DriveConfig {
  std::uint8_t node_id = 1;
  std::string name = "simulated drive";  // object 0x1008
  std::uint16_t heartbeat_ms = 0;        // object 0x1017 at power-on; 0: none until it is written
  // At most 4 of each, numbers 1..4. Empty: TPDO1 = 0x6041 + 0x6064 with every SYNC; RPDO1 = 0x6040 + 0x607A.
  std::vector<TpdoConfig> tpdos;
  std::vector<TpdoConfig> rpdos;
  // Goes to NMT operational, and to "operation enabled", without being told: for streams that nobody commands.
  bool self_starting = false;
  // The actual position follows the targets (CSP at once, PP with the profile velocity); else the owner sets it.
  bool follows_targets = false;
};

// Where a drive's frames go.
class Cia402DriveOutput {
 public:
  virtual ~Cia402DriveOutput() = default;
  virtual void send(const CanFrame& frame) = 0;
};

class Cia402Drive final : private SdoObjects {
 public:
  // `output` outlives the drive. Off until power_on(). Breaks its contract for mappings that are not valid.
  Cia402Drive(const Cia402DriveConfig& config, Cia402DriveOutput& output);

  void power_on(Timestamp now);  // boot-up message, then pre-operational (or operational where self-starting)
  void power_off();              // silent, deaf; objects return to their defaults with the next power_on()

  // Any frame of the bus; what does not concern this node is ignored.
  void receive(const CanFrame& frame, Timestamp now);
  // Sends what is due: heartbeat, event timers, motion. Call at next_due() or more often.
  void advance(Timestamp now);
  // "Never" while nothing is timed.
  [[nodiscard]] Timestamp next_due() const;

  // The measured values in the drive's units: increments, increments a second, thousandths of the rated torque.
  void set_actual(std::int32_t position, std::int32_t velocity, std::int16_t torque, Timestamp now);
  // Any mapped or readable integer object, e.g. to make a value implausible on purpose. False where it does not exist.
  bool set_object(ObjectAddress address, std::int64_t value);
  // EMCY, object 0x603F, state "fault" until a fault reset. `error_register`: object 0x1001.
  void raise_fault(std::uint16_t code, std::uint8_t error_register, Timestamp now);
  void clear_fault(Timestamp now);  // as a fault reset would
  void set_state(Cia402State state, Timestamp now);

  [[nodiscard]] std::uint8_t node_id() const { return node_; }
  [[nodiscard]] bool is_powered() const { return powered_; }
  [[nodiscard]] NmtState nmt_state() const { return nmt_; }
  [[nodiscard]] Cia402State state() const { return state_; }
  [[nodiscard]] DriveMode mode() const;
  [[nodiscard]] std::int32_t target_position() const;
  [[nodiscard]] std::int32_t position() const;
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] const ObjectDictionary& objects() const { return objects_; }

 private:
  struct Tpdo {
    std::uint32_t cob_id = 0;
    bool valid = false;
    std::uint8_t transmission_type = 255;
    Nanoseconds inhibit{0};
    Nanoseconds event_timer{0};
    std::vector<PdoEntryConfig> entries;
    unsigned syncs = 0;    // since it was sent
    Timestamp sent;        // last time
    Timestamp event_due;   // event timer
    bool pending = false;  // a change waits for the end of the inhibit time
    std::vector<std::uint64_t> last;
  };
  struct Rpdo {
    std::uint32_t cob_id = 0;
    bool valid = false;
    bool on_sync = false;
    std::vector<PdoEntryConfig> entries;
    std::optional<CanFrame> waiting;  // for the next SYNC
  };

  // SdoObjects
  [[nodiscard]] std::expected<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) override;
  [[nodiscard]] std::optional<SdoAbort> write(ObjectAddress address, std::span<const std::uint8_t> value) override;

  void reset_communication(Timestamp now);
  void on_nmt(NmtMessage message, Timestamp now);
  void enter(NmtState state, Timestamp now);
  void on_sync(Timestamp now);
  void on_rpdo(Rpdo& rpdo, const CanFrame& frame, Timestamp now);
  void apply_rpdo(const Rpdo& rpdo, const CanFrame& frame, Timestamp now);
  void after_write(ObjectAddress address, Timestamp now);
  void on_controlword(std::uint16_t controlword, Timestamp now);
  void on_new_set_point(std::uint16_t controlword);
  void follow(Timestamp now);
  void update_statusword();
  void send_emcy(std::uint16_t code, std::uint8_t error_register);

  void load_pdos();
  [[nodiscard]] std::vector<PdoEntryConfig> mapping_of(std::uint16_t index) const;
  [[nodiscard]] std::optional<SdoAbort> check_mapping_write(ObjectAddress address, std::uint64_t value) const;
  void changed(Timestamp now);
  [[nodiscard]] static bool statusword_differs(const Tpdo& tpdo, const std::vector<std::uint64_t>& values);
  void send_tpdo(Tpdo& tpdo, Timestamp now);
  [[nodiscard]] std::vector<std::uint64_t> mapped_values(const Tpdo& tpdo) const;
  [[nodiscard]] std::int64_t object(std::uint16_t index) const;

  Cia402DriveConfig config_;
  std::uint8_t node_;
  Cia402DriveOutput* output_;
  ObjectDictionary defaults_;
  ObjectDictionary objects_;
  SdoServer server_;
  std::vector<Tpdo> tpdos_;
  std::vector<Rpdo> rpdos_;
  bool powered_ = false;
  NmtState nmt_ = NmtState::boot_up;
  Cia402State state_ = Cia402State::switch_on_disabled;
  std::uint16_t controlword_ = 0;
  bool set_point_taken_ = false;
  bool target_reached_ = true;
  std::int64_t profile_target_ = 0;
  double profile_position_ = 0;
  Timestamp now_;    // of the call under way, for writes that come through the SDO server
  Timestamp moved_;  // last step of follow()
  Timestamp heartbeat_due_;
};

}  // namespace cellmirror::can
