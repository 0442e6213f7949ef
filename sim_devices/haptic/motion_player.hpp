// Plays the steps of a motion: where the hand wishes to be, from period to period. No clock.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_devices/haptic/motion_script.hpp"

namespace cellmirror::sim {

struct HandWish {
  Coordinates position{};
  Coordinates rate{};  // constant until the next call
  bool holding = true;
  std::uint32_t buttons = 0;
};

class MotionPlayer {
 public:
  // `repeat` plays the list again from its begin; where the hand is then is where its wish begins.
  MotionPlayer(std::vector<MotionStep> steps, const Coordinates& start, bool repeat);

  // The wish `dt` seconds after the last one. `efforts` is what the hand feels, `hand` where it is.
  [[nodiscard]] const HandWish& step(const Coordinates& hand, const Coordinates& efforts, double dt);
  // Goes on with other steps from where it is; `back` keeps its place.
  void replace(std::vector<MotionStep> steps);
  [[nodiscard]] bool done() const { return next_ >= steps_.size(); }
  [[nodiscard]] const HandWish& wish() const { return wish_; }

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
  HandWish wish_;
  std::size_t next_ = 0;
  bool begun_ = false;
  double t_ = 0;            // s, since the step's begin
  Coordinates from_{};      // wish at the step's begin
  Coordinates pressing_{};  // direction of the last touch
  double turn_at_ = 0;      // s into the tap's period, when it felt something
  double reached_ = 0;      // m or rad, there
};

}  // namespace cellmirror::sim
