#include "rt_core/engine/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/engine/robot_slot.hpp"

namespace cellmirror::engine {

static_assert(kMaxRobots <= 256, "slots are numbers of 8 bits");
static_assert(kMaxJointsPerRobot <= 16, "joints of a slave are bits of 16");

namespace {

bool joints_are_sound(const Coupling& coupling, const RobotTickState& master, const RobotTickState& slave) CELL_RT {
  unsigned driven = 0;
  for (std::size_t i = 0; i < coupling.count; ++i) {
    const CoupledJoint& joint = coupling.joints[i];
    if (joint.master_joint >= master.joint_count || joint.slave_joint >= slave.joint_count) return false;
    const unsigned bit = 1U << joint.slave_joint;
    if ((driven & bit) != 0) return false;
    driven |= bit;
    const double velocity = coupling.max_velocity[joint.slave_joint];
    if (!std::isfinite(velocity) || velocity <= 0.0) return false;
    // Also where it is not a number.
    if (!(coupling.max_acceleration[joint.slave_joint] > 0.0)) return false;
  }
  return true;
}

}  // namespace

bool Couplings::couple(const Coupling& coupling, std::span<RobotSlot> slots) CELL_RT {
  if (coupling.master >= slots.size() || coupling.slave >= slots.size()) return false;
  if (coupling.count == 0 || coupling.count > kMaxJointsPerRobot) return false;
  const RobotTickState& master = slots[coupling.master].state();
  const RobotTickState& slave = slots[coupling.slave].state();
  if (master.mode == RobotMode::absent || slave.mode != RobotMode::simulated) return false;
  const Coupling& present = of_slave_[coupling.slave];
  if (present.count > 0 && present.master != coupling.master) return false;
  if (coupling.master == coupling.slave || follows(coupling.master, coupling.slave)) return false;
  if (!joints_are_sound(coupling, master, slave)) return false;
  of_slave_[coupling.slave] = coupling;
  slots[coupling.slave].set_follow(coupling.master, coupling.slave_joints());
  sort();
  return true;
}

bool Couplings::restore(const Coupling& coupling, std::span<const RobotSlot> slots) {
  if (coupling.master >= slots.size() || coupling.slave >= slots.size()) return false;
  if (coupling.count == 0 || coupling.count > kMaxJointsPerRobot || of_slave_[coupling.slave].count > 0) return false;
  if (coupling.master == coupling.slave || follows(coupling.master, coupling.slave)) return false;
  if (!joints_are_sound(coupling, slots[coupling.master].state(), slots[coupling.slave].state())) return false;
  of_slave_[coupling.slave] = coupling;
  sort();
  return true;
}

bool Couplings::uncouple(std::uint8_t slave, std::span<RobotSlot> slots) CELL_RT {
  if (slave >= slots.size() || of_slave_[slave].count == 0) return false;
  of_slave_[slave].count = 0;
  slots[slave].set_follow(0, 0);
  sort();
  return true;
}

void Couplings::remove(std::uint8_t slot, std::span<RobotSlot> slots) CELL_RT {
  if (slot >= slots.size()) return;
  for (std::size_t slave = 0; slave < of_slave_.size(); ++slave) {
    if (of_slave_[slave].count > 0 && (slave == slot || of_slave_[slave].master == slot))
      uncouple(static_cast<std::uint8_t>(slave), slots);
  }
}

// Through however many others. There are no circles yet, so that the way up ends.
bool Couplings::follows(std::size_t slave, std::size_t master) const CELL_RT {
  for (std::size_t up = 0; up < of_slave_.size() && of_slave_[slave].count > 0; ++up) {
    slave = of_slave_[slave].master;
    if (slave == master) return true;
  }
  return false;
}

// By how many masters are above a slave.
void Couplings::sort() CELL_RT {
  std::size_t deepest = 0;
  for (std::size_t slave = 0; slave < of_slave_.size(); ++slave) {
    depth_[slave] = 0;
    for (std::size_t at = slave; of_slave_[at].count > 0 && depth_[slave] < of_slave_.size(); at = of_slave_[at].master)
      ++depth_[slave];
    deepest = std::max<std::size_t>(deepest, depth_[slave]);
  }
  count_ = 0;
  for (std::size_t level = 1; level <= deepest; ++level) {
    for (std::size_t slave = 0; slave < of_slave_.size(); ++slave) {
      if (depth_[slave] == level) order_[count_++] = static_cast<std::uint8_t>(slave);
    }
  }
}

std::span<const std::uint8_t> Couplings::step(double dt, std::span<RobotSlot> slots) CELL_RT {
  std::size_t moved = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Coupling& coupling = of_slave_[order_[i]];
    if (slots[coupling.slave].follow(slots[coupling.master].state(), coupling, dt)) moved_[moved++] = coupling.slave;
  }
  return std::span(moved_).first(moved);
}

}  // namespace cellmirror::engine
