// Where the modes of a drive want the axis to be: profile position, profile velocity, and the cyclic positions of a
// master (CiA 402-2, 8, 10, 12 and 13). Increments and seconds. Pure.
#pragma once

#include <optional>

#include "drivers/can/cia402/device/motion_plan.hpp"

namespace cellmirror::can {

// A plan that runs.
class RunningPlan {
 public:
  void start(const MotionPlan& plan);
  [[nodiscard]] MotionPoint step(double dt);
  [[nodiscard]] bool is_over() const { return time_ >= plan_.duration(); }

 private:
  MotionPlan plan_;
  double time_ = 0;
};

// Set-points: one under way and one that waits for its end.
class ProfilePosition {
 public:
  void enter(const MotionPoint& at, double deceleration);
  // False where no room is left. `immediately`: replaces the one under way. `pass`: else the axis does not stop at the
  // target before it, but passes that with its velocity.
  bool set_point(const MotionPoint& at, double target, const MotionLimits& limits, bool immediately, bool pass = false);
  [[nodiscard]] bool has_room() const { return !waiting_; }
  void halt(const MotionPoint& at, double deceleration);
  void resume(const MotionPoint& at);
  [[nodiscard]] MotionPoint step(double dt);
  // The last set-point, which the one that waits does not change.
  [[nodiscard]] double target() const { return under_way_.target; }
  // What a relative set-point adds to: the last one that was given.
  [[nodiscard]] double newest_target() const { return waiting_ ? waiting_->target : under_way_.target; }
  [[nodiscard]] bool is_over() const { return plan_.is_over() && !waiting_ && !halted_; }
  [[nodiscard]] bool is_halted() const { return halted_; }

 private:
  struct SetPoint {
    double target = 0;
    MotionLimits limits;
  };

  void start_under_way(const MotionPoint& at);
  void take_waiting(const MotionPoint& at);

  SetPoint under_way_;
  std::optional<SetPoint> waiting_;
  RunningPlan plan_;
  bool halted_ = false;
  double passing_ = 0;  // the direction in which it passes its target; 0: it stops there
};

class ProfileVelocity {
 public:
  // Ramps to `velocity`.
  void aim(const MotionPoint& at, double velocity, const MotionLimits& limits);
  // `actual`: where the axis is. It stops before `lower` and `upper`.
  [[nodiscard]] MotionPoint step(double dt, double actual, double lower, double upper);
  [[nodiscard]] double aimed() const { return aimed_; }
  [[nodiscard]] bool is_limited() const { return limited_; }  // by the software limits

 private:
  double aimed_ = 0;
  MotionLimits limits_;
  RunningPlan plan_;
  MotionPoint at_;
  bool limited_ = false;
};

// Linear interpolation from target to target, each reached one period after it came.
class CyclicPosition {
 public:
  void enter(const MotionPoint& at) { at_ = {at.position, 0, 0}, left_ = 0, target_ = at.position; }
  void aim(double target, double period);
  [[nodiscard]] MotionPoint step(double dt);

 private:
  MotionPoint at_;
  double target_ = 0;
  double left_ = 0;  // s until the target
};

}  // namespace cellmirror::can
