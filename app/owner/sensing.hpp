// SCRIPT's commands for ultrasonic sensors and collision tests (SET_USSPAR, SET_COLLPAR), and the settings that they
// change. Belongs to the thread that owns the cell.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "rt_core/cell/cell.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "scripts/commands/host.hpp"

namespace cellmirror::app {

class CellSensing final : public SensingHost {
 public:
  static constexpr std::size_t kMaxRules = 10'000;

  // `collision`: of the cell file.
  CellSensing(Cell& cell, collision::Settings collision)
      : cell_(cell), collision_(std::make_shared<const collision::Settings>(std::move(collision))) {}

  Result<void> set_sensor_active(std::string_view sensor, bool active) override;
  Result<void> set_sensor_range(std::string_view sensor, double range_m) override;
  Result<void> set_range_send_mode(RangeSendMode mode) override;
  Result<void> set_collision_active(bool active) override;
  Result<void> set_collision_warning(double distance_m) override;
  Result<void> set_collision_pair(std::string_view a, std::string_view b, PairTreatment treatment) override;

  // Never changed, only replaced.
  [[nodiscard]] const std::shared_ptr<const collision::Settings>& collision() const { return collision_; }
  [[nodiscard]] RangeSendMode send_mode() const { return send_mode_; }

 private:
  Cell& cell_;
  std::shared_ptr<const collision::Settings> collision_;
  RangeSendMode send_mode_ = RangeSendMode::one_message_a_sensor;  // manual 1.2.1
};

}  // namespace cellmirror::app
