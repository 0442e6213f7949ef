// A hand that holds the handle of a haptic device: every axis is an oscillator about the hand's target, driven by the
// device's force, with tremor.
#pragma once

#include <array>
#include <cstdint>

#include "sim_devices/haptic/axes.hpp"
#include "sim_devices/haptic/oscillator.hpp"

namespace cellmirror::sim {

// Of a length axis, with the handle in it; angles are turned at an arm of `arm`, wrists and grippers see the small
// ones. Sizes as in the literature on grasped haptic devices (a few 0.1 kg, some Ns/m, some 100 N/m).
struct HandParameters {
  Impedance held{0.25, 6.0, 300.0};    // kg, Ns/m, N/m
  Impedance released{0.06, 0.1, 0.0};  // the device alone
  Impedance wrist{1e-3, 0.04, 2.0};    // kg m2, Nms/rad, Nm/rad: handle rotations, roll, gripper
  double arm = 0.15;                   // m, from the trocar to the hand: yaw and pitch
  double tremor = 0;                   // m, amplitude at the target; angles: over the arm
  double tremor_low_hz = 8;            // physiological tremor: 8 to 12 Hz
  double tremor_high_hz = 12;
  std::uint64_t seed = 1;
};

class Hand {
 public:
  static constexpr double kLongestStep = 250e-6;  // s

  Hand(const AxisLayout& layout, const HandParameters& parameters, const Coordinates& start);

  // `wish` and `wish_rate` are those at the step's begin; the efforts are constant. Several steps of at most
  // kLongestStep. Without `holding` only the device's own mass and friction are left.
  void step(const Coordinates& wish, const Coordinates& wish_rate, const Coordinates& efforts, bool holding, double dt);

  [[nodiscard]] const Coordinates& coordinates() const { return x_; }
  [[nodiscard]] const Coordinates& rates() const { return v_; }
  // Mechanical energy that the efforts gave to the hand since the start, J.
  [[nodiscard]] double work() const { return work_; }

 private:
  static constexpr std::size_t kTones = 4;
  struct Tone {
    double omega;
    double phase;
  };
  [[nodiscard]] double tremor(std::size_t axis, double t) const;

  std::size_t axes_;
  std::array<Impedance, kMaxHapticAxes> held_{};
  std::array<Impedance, kMaxHapticAxes> released_{};
  std::array<double, kMaxHapticAxes> amplitude_{};
  std::array<std::array<Tone, kTones>, kMaxHapticAxes> tones_{};
  Coordinates x_;
  Coordinates v_{};
  double t_ = 0;
  double work_ = 0;
};

}  // namespace cellmirror::sim
