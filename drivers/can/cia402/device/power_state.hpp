// The power state machine of a drive in time (CiA 402-2, 6.4): the transitions that a controlword asks for, a fault,
// and the stops that lie between two states. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/can/cia402/device/servo_objects.hpp"
#include "drivers/can/cia402/state.hpp"

namespace cellmirror::can {

// How the axis is brought to a standstill.
enum class StopRamp : std::uint8_t { slow_down, quick_stop };

class PowerState {
 public:
  [[nodiscard]] Cia402State state() const { return state_; }
  // The motor has torque.
  [[nodiscard]] bool is_powered() const;
  // The ramp that is under way instead of the mode; still there while the axis is held after a quick stop.
  [[nodiscard]] std::optional<StopRamp> stopping() const { return stopping_; }

  void reset();    // not ready to switch on
  void started();  // transition 1
  void command(std::uint16_t controlword, const ServoParameters& parameters);
  void fault(const ServoParameters& parameters);  // transition 13
  void quick_stop(const ServoParameters& parameters);
  void disable_voltage();
  // The axis stands: a stop that is under way ends.
  void stands(const ServoParameters& parameters);

 private:
  void leave_operation(Cia402State wanted, int option);
  void enter(Cia402State state);

  Cia402State state_ = Cia402State::not_ready_to_switch_on;
  std::uint16_t controlword_ = 0;
  std::optional<StopRamp> stopping_;
  Cia402State after_stop_ = Cia402State::switch_on_disabled;
};

}  // namespace cellmirror::can
