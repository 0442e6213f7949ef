// The masses and drives of a robot, in the form that inverse dynamics wants: a tree of joints, fixed size, immutable.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::dynamics {

inline constexpr std::size_t kMaxLinks = kinematics::kMaxChainJoints;

// Mass, centre of mass and moments of a rigid body in some frame. Moments about the centre of mass.
struct Inertia {
  double mass = 0;                                // kg
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();  // m
  Eigen::Matrix3d I_C = Eigen::Matrix3d::Zero();  // kg m2
};
// The same body in frame A, given in frame B.
[[nodiscard]] Inertia moved(const Inertia& inertia, const Pose& X_AB);
// Both together.
[[nodiscard]] Inertia joined(const Inertia& a, const Inertia& b);

// A joint with everything that moves with it up to the next joints. Its value is multiplier * q[variable] + offset.
struct Link {
  std::int8_t parent = -1;       // link before it; -1: the base
  Pose X_PJ = Pose::Identity();  // the joint's frame at value zero, in the parent's joint frame (in the base)
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector in J
  JointKind kind = JointKind::revolute;
  std::uint8_t variable = 0;  // joint of the robot
  double multiplier = 1.0;
  double offset = 0.0;
  Inertia inertia;  // in J
};

// Joint side, as in the component file. Zero: not known, left out.
struct Drive {
  double gear_ratio = 0;
  double rotor_inertia = 0;     // kg m2, motor side
  double coulomb_friction = 0;  // Nm or N
  double viscous_friction = 0;  // Nm s/rad or N s/m
  double max_effort = 0;        // Nm or N
};

class Mechanism {
 public:
  // Parents stand before their children. Refused: more links than kMaxLinks, what is not finite, negative masses,
  // moments that no body can have, an unknown parent or variable.
  static Result<Mechanism> make(std::size_t variables, std::span<const Link> links, std::span<const Drive> drives,
                                int tip_link, const Pose& X_LT);

  [[nodiscard]] std::size_t variable_count() const CELL_RT { return variable_count_; }
  [[nodiscard]] std::span<const Link> links() const CELL_RT { return {links_.data(), link_count_}; }
  [[nodiscard]] const Drive& drive(std::size_t variable) const CELL_RT { return drives_[variable]; }
  [[nodiscard]] int tip_link() const CELL_RT { return tip_link_; }  // that carries the TCP
  [[nodiscard]] const Pose& X_LT() const CELL_RT { return X_LT_; }  // TCP in that link's joint frame
  [[nodiscard]] double moving_mass() const CELL_RT;                 // kg; 0: nothing is known of its masses
  // Something of `inertia` (in the TCP's frame) held at the TCP besides.
  [[nodiscard]] Mechanism with_payload(const Inertia& inertia) const;

 private:
  Mechanism() = default;
  std::size_t variable_count_ = 0;
  std::size_t link_count_ = 0;
  std::array<Link, kMaxLinks> links_{};
  std::array<Drive, kMaxJointsPerRobot> drives_{};
  int tip_link_ = -1;
  Pose X_LT_ = Pose::Identity();
};

}  // namespace cellmirror::dynamics
