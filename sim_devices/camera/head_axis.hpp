// One axis of a pan-tilt head: moves to its target as fast as its limits allow. Virtual time; rad.
#pragma once

namespace cellmirror::sim {

struct AxisLimits {
  double least = -3.0;  // rad: stops
  double most = 3.0;
  double speed = 1.5;         // rad/s
  double acceleration = 6.0;  // rad/s^2
};

class HeadAxis {
 public:
  // Sets it to `position`, within the stops.
  HeadAxis(const AxisLimits& limits, double position);

  // Moves by `dt` seconds (0 to a second; more counts as one) towards `goal`, which is clamped to the stops first.
  // `speed_scale`: of the maximum speed, 0 to 1. Brakes in time to stop at the goal.
  void step(double goal, double speed_scale, double dt);
  void stop() { velocity_ = 0; }

  [[nodiscard]] double position() const { return position_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] const AxisLimits& limits() const { return limits_; }
  [[nodiscard]] double within_stops(double position) const;

 private:
  void small_step(double goal, double largest_speed, double dt);

  AxisLimits limits_;
  double position_;
  double velocity_ = 0;
};

}  // namespace cellmirror::sim
