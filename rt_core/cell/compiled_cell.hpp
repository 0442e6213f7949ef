// An immutable snapshot of the cell for all readers: flat arrays, no look-up by name needed. Threads: any number of
// readers; shared by std::shared_ptr, released outside the tick.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror {

// A joint of the tree and what drives it: position = multiplier * q[slot][joint] + offset (multiplier 1, offset 0 but
// for mimics).
struct CompiledJoint {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double multiplier = 1.0;
  double offset = 0.0;
  JointKind kind = JointKind::revolute;
  std::uint8_t slot = 0;   // of the robot
  std::uint8_t joint = 0;  // number in the robot
};

struct CompiledRobot {
  std::string id;
  std::size_t slot = 0;
  std::vector<std::string> joint_names;  // bare names, in the order of the file
  std::vector<JointKind> joint_kinds;
  std::vector<JointDrive> drives;
  JointValues min_range{};  // rad or m; what SCRIPT's parameters say at this revision
  JointValues max_range{};
  JointValues start_position{};
  std::vector<std::int32_t> joint_nodes;  // indices into the arrays of the cell, as all below
  std::int32_t component = 0;             // the node whose ABSTRACT file holds the robot
  std::int32_t base = 0;
  std::int32_t zero_point = 0;
  std::int32_t flange = 0;
  Pose X_FT = Pose::Identity();  // TCP in the flange (point of reference and tool centre point)
};

struct CompiledCamera {
  std::string name;
  std::int32_t node = 0;
  double focal_distance_m = 0;
  double fovy_rad = 0;
};

struct CompiledSensor {
  std::string name;
  std::int32_t node = 0;
  SensorDefinition sensor;
};

struct CompiledGeometry {
  std::int32_t node = 0;
  std::shared_ptr<const Geometry> geometry;
};

struct CompiledVolume {
  std::int32_t node = 0;
  std::shared_ptr<const ComponentVolume> volume;
};

struct CompiledInertia {
  std::int32_t node = 0;
  BodyInertia inertia;
};

// Arrays are indexed by node. Parents come before their children; nodes that no joint can move come first.
struct CompiledCell {
  std::uint64_t revision = 0;
  std::string name = "world";        // of the cell, and so of its own geometry in results: the world has no path
  std::vector<std::int32_t> parent;  // kinematic predecessor; -1 for the world (index 0)
  std::vector<std::int32_t> naming_parent;
  std::vector<Pose> X_PF;              // pose in the predecessor, at joint position zero
  std::vector<std::int32_t> joint_of;  // into `joints`, -1: not a joint
  std::vector<std::uint8_t> visible;
  std::vector<Pose> X_WN_fixed;  // world poses of the first `fixed_count` nodes
  std::size_t fixed_count = 0;
  std::vector<CompiledJoint> joints;
  std::vector<CompiledRobot> robots;                     // in the order of their slots
  std::array<std::int16_t, kMaxRobots> robot_of_slot{};  // into `robots`, -1: none
  std::vector<CompiledCamera> cameras;
  std::vector<CompiledSensor> sensors;
  std::vector<std::int32_t> workframes;    // nodes; those of cameras and sensors are not among them
  std::vector<CompiledGeometry> geometry;  // what is visible, coarse geometry included
  std::vector<CompiledVolume> volumes;     // of all components in memory; drawn where `visible`
  // Of what is there: not hidden (DEACTIVATE), by itself or with what it is named within. A part that is shown coarsely
  // weighs what it weighs in detail. A node may have two: its own and that of its component's root.
  std::vector<CompiledInertia> inertia;
  std::shared_ptr<const std::vector<std::string>> paths;  // full dotted paths; shared as long as the tree stays

  [[nodiscard]] std::size_t size() const { return parent.size(); }
  [[nodiscard]] const CompiledRobot* robot(std::size_t slot) const;
};

// The motion of a joint: rotation about or translation along its axis (a unit vector), by rad or m.
[[nodiscard]] Pose joint_motion(JointKind kind, const Eigen::Vector3d& axis, double position) CELL_RT;

// World poses of all nodes of a CompiledCell, kept from one computation to the next so that what cannot move is not
// computed again.
struct CellPoses {
  std::uint64_t revision = 0;  // of the cell for which X_WN holds the fixed part
  std::vector<Pose> X_WN;

  // Makes room, so that compute_poses() allocates nothing for cells up to `nodes`.
  void reserve(std::size_t nodes) { X_WN.reserve(nodes); }
};

// World poses at the joint positions q[slot][joint] (rad, m). `q` reaches at least to the highest slot in use. Takes
// heap memory only where `poses` was not reserved for a cell of this size.
void compute_poses(const CompiledCell& cell, std::span<const JointValues> q, CellPoses& poses);

struct TcpPoses {
  Pose X_BT = Pose::Identity();  // TCP in the robot's base
  Pose X_ZT = Pose::Identity();  // TCP in the robot's ZP frame
  Pose X_WT = Pose::Identity();  // TCP in the world
};
// From poses that compute_poses() made for this cell. No heap memory.
[[nodiscard]] TcpPoses tcp_poses(const CompiledRobot& robot, const CellPoses& poses) CELL_RT;

}  // namespace cellmirror
