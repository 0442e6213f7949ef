// A cell from texts in memory with its pairs, its checker and a posture.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "rt_core/collision/checker.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::collision {

// Four axes: about z, then twice about y, then about z. Upright at zero; every link has a body, the base too.
inline constexpr const char* kBodiedArm = R"(
geometry = [{ name = "base", box_m = [0.3, 0.3, 0.4], xyz_m = [0.0, 0.0, 0.2] }]
[[node]]
name = "J_1"
xyz_m = [0.0, 0.0, 0.5]
geometry = [{ name = "shoulder", cylinder_m = [0.1, 0.16] }]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3.0, 3.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_2"
parent = "J_1"
xyz_m = [0.0, 0.0, 0.2]
geometry = [{ name = "upper arm", capsule_m = [0.05, 0.5], xyz_m = [0.0, 0.0, 0.3] }]
joint = { type = "revolute", axis = [0, 1, 0], range_rad = [-2.9, 2.9], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_3"
parent = "J_2"
xyz_m = [0.0, 0.0, 0.6]
geometry = [{ name = "forearm", capsule_m = [0.05, 0.3], xyz_m = [0.0, 0.0, 0.22] }]
joint = { type = "revolute", axis = [0, 1, 0], range_rad = [-2.0, 2.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_4"
parent = "J_3"
xyz_m = [0.0, 0.0, 0.45]
geometry = [{ name = "wrist", sphere_m = 0.06 }]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3.0, 3.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "FLANGE"
parent = "J_4"
xyz_m = [0.0, 0.0, 0.07]
[robot]
id = "ARM"
flange = "FLANGE"
)";

// A ball of 0.1 m radius that a linear axis carries along x; at 0 its centre is the component's origin.
inline constexpr const char* kSledge = R"(
[[node]]
name = "X"
geometry = [{ name = "ball", sphere_m = 0.1 }]
joint = { type = "prismatic", axis = [1, 0, 0], range_m = [-10.0, 10.0], velocity_m_s = 1.5, acceleration_m_s2 = 3.0 }
[robot]
id = "SLEDGE"
flange = "X"
)";

struct CellOfBodies : testing::Test {
  CellOfBodies() {
    files->add("arm.mpc", kBodiedArm);
    files->add("sledge.mpc", kSledge);
  }

  void build(const std::string& nodes, const std::map<std::string, std::string>& predecessors = {}) {
    Diagnostics diagnostics;
    cell = build_cell(nodes, files, diagnostics, predecessors);
    ASSERT_TRUE(cell) << diagnostics.text();
    q = cell->start_positions();
    derive();
  }

  void derive() {
    compiled = cell->compile();
    table = derivation.derive(*compiled, settings);
  }
  void adopt() {
    derive();
    sut.adopt(compiled, table, settings);
  }

  const ProximityState& check() {
    compute_poses(*compiled, q, poses);
    return sut.check(poses, Timestamp{++now});
  }
  double& joint(const std::string& robot, std::size_t index) { return q[cell->robot(robot)->slot()][index]; }

  // Null: rigid, or no such bodies.
  const Pair* pair(const std::string& a, const std::string& b) const {
    for (const Pair& candidate : table->pairs) {
      const std::string& first = (*table->names)[candidate.a];
      const std::string& second = (*table->names)[candidate.b];
      if ((first == a && second == b) || (first == b && second == a)) return &candidate;
    }
    return nullptr;
  }
  PairState state(const std::string& a, const std::string& b) const {
    const Pair* found = pair(a, b);
    return found == nullptr ? PairState::rigid : found->state;
  }
  bool has_body(const std::string& name) const {
    return std::find(table->names->begin(), table->names->end(), name) != table->names->end();
  }

  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> cell;
  Settings settings;
  PairDerivation derivation{std::make_shared<geometry::SolidLibrary>()};
  std::shared_ptr<const CompiledCell> compiled;
  std::shared_ptr<const PairTable> table;
  std::vector<JointValues> q;
  CellPoses poses;
  std::int64_t now = 0;
  Checker sut;
};

inline std::ostream& operator<<(std::ostream& out, PairState state) {
  constexpr std::array kNames{"tested", "rigid", "neighbours", "always", "never", "rule_ignore", "rule_test"};
  return out << kNames[static_cast<std::size_t>(state)];
}

}  // namespace cellmirror::collision
