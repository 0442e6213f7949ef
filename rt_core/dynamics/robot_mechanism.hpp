// The mechanisms of the robots of a cell.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/dynamics/mechanism.hpp"

namespace cellmirror::dynamics {

// What drives a variable of the mechanism.
struct VariableSource {
  std::uint8_t slot = 0;   // of the robot
  std::uint8_t joint = 0;  // number in the robot
};

struct RobotMechanism {
  std::size_t slot = 0;
  std::optional<Mechanism> mechanism;  // the base is the world
  std::string why_not;                 // of a robot with masses without a mechanism
  // The same links with nothing but what `payload_kg` counts; none where that is nothing.
  std::optional<Mechanism> load;
  // By variable: first all joints of the robot itself, then those of robots that carry it or that it carries, by slot
  // and joint. All of them together move its links.
  std::vector<VariableSource> variables;
  std::vector<std::int32_t> link_nodes;   // by link: the joint's node
  std::vector<std::int32_t> joint_links;  // by joint of the robot: its own link (no mimic's)
  double model_kg = 0;    // of the robot's own model, on its moving links; 0 and no moments: it has no mechanism
  double payload_kg = 0;  // of what moves with its links besides: attached parts, and robots that it carries
};

// One for each of cell.robots, in that order. A node belongs to the last joint on its way from the world (kinematic
// predecessors). A robot whose model has no masses on its links has no mechanism, whatever it carries: a partial weight
// would be wrong. Joints of other robots between the world and the robot, or beyond its joints, are part of its
// mechanism, so their motion has an effect; robots that only share the carrier are not. One pass over the cell per
// robot.
[[nodiscard]] std::vector<RobotMechanism> robot_mechanisms(const CompiledCell& cell);

// Whether the two give the same mechanisms. Costs some ten microseconds a thousand nodes where they do.
[[nodiscard]] bool same_masses(const CompiledCell& a, const CompiledCell& b);

}  // namespace cellmirror::dynamics
