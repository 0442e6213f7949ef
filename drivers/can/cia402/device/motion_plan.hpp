// Motion of one axis in closed form: pieces of constant acceleration. Pure.
#pragma once

#include <array>
#include <cstddef>

namespace cellmirror::can {

// Any unit of length u: u, u/s, u/s2.
struct MotionPoint {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

// All positive. Deceleration is of the speed, whatever the direction.
struct MotionLimits {
  double velocity = 1;
  double acceleration = 1;
  double deceleration = 1;
};

class MotionPlan {
 public:
  MotionPlan() = default;
  [[nodiscard]] static MotionPlan rest(double position);
  // To a standstill at `target`, as fast as the limits allow (trapezoidal profile of the velocity). Where the axis
  // moves away from the target, or too fast to stop before it, it stops first and comes back.
  [[nodiscard]] static MotionPlan to_position(const MotionPoint& from, double target, const MotionLimits& limits);
  // To a velocity, which it keeps; through a standstill where the direction changes.
  [[nodiscard]] static MotionPlan to_velocity(const MotionPoint& from, double velocity, const MotionLimits& limits);

  // `t` seconds after the start, at least 0. After the last piece the velocity is kept.
  [[nodiscard]] MotionPoint at(double t) const;
  // Until the velocity does not change any more [s].
  [[nodiscard]] double duration() const { return duration_; }

 private:
  struct Piece {
    double duration = 0;  // s
    MotionPoint start;
  };

  void add(double duration, double acceleration);
  void brake(const MotionLimits& limits);

  std::array<Piece, 5> pieces_{};
  std::size_t count_ = 0;
  MotionPoint end_;  // of the last piece
  double duration_ = 0;
};

}  // namespace cellmirror::can
