// How points of an instrument move when its tip is translated: through the joints, which turn a shaft about its trocar.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::contact_model {

class Levers {
 public:
  // Keeps nothing of the cell. The robot is one of it.
  void adopt(const CompiledCell& cell, const CompiledRobot& robot);
  // Whether a joint of the robot moves the node.
  [[nodiscard]] bool moves(std::int32_t node) const { return !joints_above(node).empty(); }

  // A new posture, of the cell that was adopted. No heap memory.
  void move(const CellPoses& poses);
  [[nodiscard]] const Eigen::Vector3d& tip() const { return tip_; }  // m, origin of the TCP in the world
  // By how much the point `p_W`, fixed to a node, moves for a translation of the tip: displacement = M * tip's. Where
  // the joints cannot translate the tip in some direction, M answers only to the others.
  [[nodiscard]] Eigen::Matrix3d lever(std::int32_t node, const Eigen::Vector3d& p_W) const;

 private:
  struct MovingJoint {
    std::int32_t node = 0;
    JointKind kind = JointKind::revolute;
    std::uint8_t joint = 0;  // of the robot
    double multiplier = 1.0;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // in the joint's frame
    Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] const std::vector<std::uint32_t>& joints_above(std::int32_t node) const {
    return above_[static_cast<std::size_t>(node)];
  }
  // What one unit of the robot's joint moves a point by.
  [[nodiscard]] static Eigen::Vector3d velocity(const MovingJoint& joint, const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d v =
        joint.kind == JointKind::prismatic ? joint.axis_W : joint.axis_W.cross(Eigen::Vector3d(p_W - joint.origin_W));
    return joint.multiplier * v;
  }

  // M of a point is affine in it: base + x * along[0] + y * along[1] + z * along[2], in the world.
  struct AffineLever {
    Eigen::Matrix3d base = Eigen::Matrix3d::Zero();
    std::array<Eigen::Matrix3d, 3> along{};
  };

  std::vector<MovingJoint> joints_;
  std::vector<std::vector<std::uint32_t>> above_;  // by node: joints of the robot on the way to the world
  std::vector<AffineLever> affine_;                // by joint: of what it carries; the last joint above a node decides
  std::int32_t flange_ = 0;
  Pose X_FT_ = Pose::Identity();
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();
};

}  // namespace cellmirror::contact_model
