// Master and slave: joints of a robot that follow joints of another (MASTER_SLAVE, manual 1.2.4).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/limiter.hpp"
#include "rt_core/ports/coupled_joint.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::engine {

class RobotSlot;

using CoupledJoints = std::array<CoupledJoint, kMaxJointsPerRobot>;

// The coupling of one slave. A coupled joint follows the master's value within the slave's own velocity, acceleration
// and range (rt_core/motion/pursuit.hpp); the slave's other joints stay free.
struct Coupling {
  std::uint8_t master = 0;  // slots
  std::uint8_t slave = 0;
  std::uint8_t count = 0;
  CoupledJoints joints{};
  JointValues max_velocity{};                  // rad/s or m/s, of the slave's joints
  JointValues max_acceleration = unlimited();  // rad/s2 or m/s2, likewise

  [[nodiscard]] std::uint16_t slave_joints() const CELL_RT {
    unsigned mask = 0;
    for (std::size_t i = 0; i < count; ++i) mask |= 1U << joints[i].slave_joint;
    return static_cast<std::uint16_t>(mask);
  }
};

// All couplings of the cell. Tick thread only. A slave has one master; masters may be slaves themselves.
class Couplings {
 public:
  // All of `robots` may be slaves. Every `slots` below has that many elements.
  explicit Couplings(std::size_t robots) : of_slave_(robots), depth_(robots), order_(robots), moved_(robots) {}

  // Takes the place of the slave's coupling to the same master. False where it is not sound: slots that are not used, a
  // slave that is not simulated, joints that are not there or driven twice, a velocity that is not positive, another
  // master, a circle.
  bool couple(const Coupling& coupling, std::span<RobotSlot> slots) CELL_RT;
  // False where it follows no master. It stays where it is.
  bool uncouple(std::uint8_t slave, std::span<RobotSlot> slots) CELL_RT;
  // The robot in this slot is gone: so are the couplings in which it has a part.
  void remove(std::uint8_t slot, std::span<RobotSlot> slots) CELL_RT;

  // Moves the slaves on by `dt` seconds, masters before their slaves, so that a value passes through all of a chain
  // within one tick. After samples and moves, and after the states of the joints were brought up to date: a slave holds
  // where the master's data are not fresh. Returns the slots that have moved, valid until the next step.
  std::span<const std::uint8_t> step(double dt, std::span<RobotSlot> slots) CELL_RT;

  // By the slave's slot; of a count of 0: it follows no master.
  [[nodiscard]] std::span<Coupling> all() CELL_RT { return of_slave_; }
  // As it was in another engine, whose robots stand in `slots` already. False where it is not sound. Not for the tick.
  bool restore(const Coupling& coupling, std::span<const RobotSlot> slots);

 private:
  [[nodiscard]] bool follows(std::size_t slave, std::size_t master) const CELL_RT;
  void sort() CELL_RT;

  std::vector<Coupling> of_slave_;    // by the slave's slot; count 0: it follows no master
  std::vector<std::uint16_t> depth_;  // by slot: how many masters are above it
  std::vector<std::uint8_t> order_;   // of the slaves, masters first; the first count_ count
  std::size_t count_ = 0;
  std::vector<std::uint8_t> moved_;  // in the last step
};

}  // namespace cellmirror::engine
