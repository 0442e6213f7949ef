// Plays the steps of a motion: the target of the hand in each period. No clock.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_devices/haptic/motion_script.hpp"

namespace cellmirror::sim {

struct HandTarget {
  Coordinates position{};
  Coordinates rate{};  // constant until the next call
  bool holding = true;
  std::uint32_t buttons = 0;
};

class MotionPlayer {
 public:
  // `repeat` plays the list again from the start; the target then begins at the hand's position.
  MotionPlayer(std::vector<MotionStep> steps, const Coordinates& start, bool repeat);

  // The target `dt` seconds after the last one. `efforts` on the hand, `hand` its position.
  [[nodiscard]] const HandTarget& step(const Coordinates& hand, const Coordinates& efforts, double dt);
  // Continues with other steps from its position; `back` keeps its start position.
  void replace(std::vector<MotionStep> steps);
  [[nodiscard]] bool done() const { return next_ >= steps_.size(); }
  [[nodiscard]] const HandTarget& wish() const { return wish_; }

 private:
  void begin(const MotionStep& step);
  bool play(const MotionStep& step, const Coordinates& hand, const Coordinates& efforts);
  bool touch(const MotionStep& step, const Coordinates& efforts);
  bool tap(const MotionStep& step, const Coordinates& efforts);
  [[nodiscard]] bool go(const Coordinates& to, double duration_s);
  void put(const Coordinates& direction, double amount);

  std::vector<MotionStep> steps_;
  Coordinates start_;
  bool repeat_;
  HandTarget wish_;
  std::size_t next_ = 0;
  bool begun_ = false;
  double t_ = 0;            // s, since the step's begin
  Coordinates from_{};      // target at the start of the step
  Coordinates pressing_{};  // direction of the last touch
  double turn_at_ = 0;      // s into the tap's period, when it felt something
  double reached_ = 0;      // m or rad, there
};

}  // namespace cellmirror::sim
