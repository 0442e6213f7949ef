// A CiA 402 drive as it answers on the bus, without a motor: the power state machine over a CANopen slave. Its owner
// says where it is, or it follows its targets at once. No I/O, no clock: frames and time are pushed in, frames come
// out. Simulators use it; a robot of the cell that answers a real controller has device/servo_drive.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/slave.hpp"
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

using Cia402DriveOutput = FrameOutput;

class Cia402Drive final : private SlaveApplication {
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

  [[nodiscard]] std::uint8_t node_id() const { return slave_.node(); }
  [[nodiscard]] bool is_powered() const { return slave_.is_powered(); }
  [[nodiscard]] NmtState nmt_state() const { return slave_.state(); }
  [[nodiscard]] Cia402State state() const { return state_; }
  [[nodiscard]] DriveMode mode() const;
  [[nodiscard]] std::int32_t target_position() const;
  [[nodiscard]] std::int32_t position() const;
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] const ObjectDictionary& objects() const { return slave_.objects(); }

 private:
  // SlaveApplication
  [[nodiscard]] std::optional<SdoAbort> check(ObjectAddress address, std::int64_t value) override;
  void written(std::span<const ObjectAddress> addresses, Timestamp now) override;
  void on_reset(Timestamp now) override;
  void synced(Timestamp now) override;
  bool communication_lost(Timestamp now) override;
  [[nodiscard]] bool is_stored(ObjectAddress address) const override;

  void on_controlword(std::uint16_t controlword, Timestamp now);
  void on_mode();
  void on_new_set_point(std::uint16_t controlword);
  void follow(Timestamp now);
  void update_statusword();
  [[nodiscard]] std::int64_t object(std::uint16_t index) const;

  Cia402DriveConfig config_;
  CanopenSlave slave_;
  Cia402State state_ = Cia402State::switch_on_disabled;
  std::uint16_t controlword_ = 0;
  bool set_point_taken_ = false;
  bool target_reached_ = true;
  std::int32_t kept_position_ = 0;  // that the last reset found
  std::int64_t profile_target_ = 0;
  double profile_position_ = 0;
  Timestamp moved_;  // last step of follow()
};

}  // namespace cellmirror::can
