// Master and slave as status shows them (MASTER_SLAVE, manual 1.2.4).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/ports/coupled_joint.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

struct CoupledJointSnapshot {
  std::string master;
  std::string slave;
  CoupledJoint joint;
  JointKind kind = JointKind::revolute;
};

struct CouplingSnapshot {
  std::string master;
  std::string slave;
  std::size_t master_slot = 0;
  std::size_t slave_slot = 0;
  std::vector<CoupledJointSnapshot> joints;
};

}  // namespace cellmirror::app
