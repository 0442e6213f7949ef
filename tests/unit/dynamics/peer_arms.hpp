// Arms with masses for comparisons with other libraries: their URDF, and the mechanism that our own reader, cell and
// builder make of it.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "rt_core/cell/cell.hpp"
#include "rt_core/dynamics/robot_mechanism.hpp"
#include "tests/unit/kinematics/shared_arms.hpp"

namespace cellmirror::dynamics {

// Gravity in the base of the URDF is (0, 0, -9.80665).
struct PeerArm {
  std::string id;
  std::string base;
  std::string tip;  // KDL's chain goes so far: it holds all links with masses
  std::string urdf;
  RobotMechanism ours;
  std::vector<std::string> joints;  // by variable
};

struct State {
  std::vector<double> q;
  std::vector<double> qd;
  std::vector<double> qdd;
};

// Of a robot in a component file (.mpc or .urdf) alone in a cell. Throws where it has none.
[[nodiscard]] RobotMechanism mechanism_of_component(const Component& component, std::vector<std::string>& joints);

// The arms of ../shared/data/robots whose URDF has masses. Empty where they are not on this machine.
[[nodiscard]] std::vector<PeerArm> arms_with_masses();

// The Manutec r3 of the transfer cell, and the same arm as a URDF, written with the numbers that DLR published in DLR's
// own frames (y upwards): independent of the transfer cell's file. `payload_kg` is held at the TCP by both.
[[nodiscard]] PeerArm manutec_r3(double payload_kg);

// Random trees of all kinds of joints with masses on every link.
[[nodiscard]] PeerArm random_tree(std::mt19937_64& random);

// Positions and velocities within +-2, accelerations within +-10.
[[nodiscard]] State random_state(std::size_t variables, std::mt19937_64& random);

}  // namespace cellmirror::dynamics
