// What the tests of haptics share: instruments, walls, and a channel driven tick by tick without threads.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <numbers>
#include <vector>

#include "rt_core/haptics/haptic_channel.hpp"

namespace cellmirror::haptics::test_rig {

// Gives what it is told to give, once, and keeps what was written.
class ScriptedPort final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& sample) CELL_RT override;
  void write(const HapticOutput& output) CELL_RT override;

  HapticRead next = HapticRead::none;
  HapticSample sample;
  HapticOutput output;
  int writes = 0;
};

// Three sliding joints along x, y, z of the world, and a roll about z: what it does can be said in one's head. A fifth
// joint, not on the way to the tip, is the jaw. Ranges +-0.5 m, roll +-3 rad, jaw 0 to 1 rad.
Instrument gantry(const HapticSettings& settings);
// A laparoscopic instrument: yaw about x and pitch about y through the world's origin, insertion along -z from 0.02 to
// 0.3 m, roll about the shaft; and the jaw.
Instrument trocar(const HapticSettings& settings);

// The profile `strict`, without what disturbs closed forms: no friction, damping, fading in, slew limit, controller.
HapticSettings plain_settings();

// Free where n . x >= offset; as the worker would tell it for an instrument at `x_ref`.
ContactConstraint plane(const Eigen::Vector3d& a, double offset, const Eigen::Vector3d& x_ref);
ContactModel model_of(const std::vector<ContactConstraint>& constraints, const Eigen::Vector3d& x_ref);

class Rig {
 public:
  explicit Rig(const Instrument& instrument);

  // One period with a good new sample, the hand (device's frame) there.
  bool tick(const Eigen::Vector3d& p_DH);
  // One period with whatever the port has been told to give.
  bool tick();
  // Puts the hand there at a speed that no guard minds, then waits for `rest` periods.
  void go(const Eigen::Vector3d& p_DH, int rest = 2);
  // Shows the device's newest sample as a good one of now.
  void fresh();

  [[nodiscard]] const HapticState& state() const { return sut.state(); }

  HapticChannel sut;
  ScriptedPort port;
  Instrument instrument;
  ContactModel model;
  bool show_model = true;
  bool keep_model_new = true;  // as a worker does that computes in each tick
  Timestamp now{1'000'000'000};
  Nanoseconds period{1'000'000};
  std::uint64_t missed = 0;
  bool device_gone = false;
  TissueForce tissue;
  bool show_tissue = false;
  std::function<void(Rig&)> tissue_worker;  // called at the beginning of each tick, with the state of the one before
  JointSample posture;
  JointValues q{};
};

}  // namespace cellmirror::haptics::test_rig
