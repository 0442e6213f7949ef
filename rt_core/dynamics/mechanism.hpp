// The masses and drives of a robot, in the form that inverse dynamics wants: a tree of joints, fixed size, immutable.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/dynamics/inertia.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::dynamics {

inline constexpr std::size_t kMaxLinks = kinematics::kMaxChainJoints;

// A joint with everything that moves with it up to the next joints. Its value is multiplier * q[variable] + offset.
struct Link {
  int parent = -1;               // link before it; -1: the base
  Pose X_PJ = Pose::Identity();  // the joint's frame at value zero, in the parent's joint frame (in the base)
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector in J
  JointKind kind = JointKind::revolute;
  std::uint8_t variable = 0;
  double multiplier = 1.0;
  double offset = 0.0;
  Inertia inertia;  // in J
};

// Joint side, as in the component file. Zero: not known, left out.
struct Drive {
  double gear_ratio = 0;        // motor turns a joint turn (rad/m for prismatic joints)
  double rotor_inertia = 0;     // kg m2, motor side
  double coulomb_friction = 0;  // Nm or N
  double viscous_friction = 0;  // Nm s/rad or N s/m
  double max_effort = 0;        // Nm or N

  // The rotor's inertia as the joint feels it: kg m2, or kg for prismatic joints.
  [[nodiscard]] double reflected_inertia() const CELL_RT { return gear_ratio * gear_ratio * rotor_inertia; }
};

// The motion of a joint in the form R_PJ = fixed + sin * sine + cos * cosine, p_PJ = p + value * slide (Rodrigues).
struct LinkMotion {
  Eigen::Matrix3d fixed;
  Eigen::Matrix3d sine;
  Eigen::Matrix3d cosine;
  Eigen::Vector3d p;
  Eigen::Vector3d slide;
};

class Mechanism {
 public:
  // Parents come before their children; one drive per variable. Refused: more than kMaxLinks links or
  // kMaxJointsPerRobot variables, an unknown parent, variable or tip link (-1: the base), an axis that is not a unit
  // vector, invalid poses, numbers that are not finite, negative friction or rotors, and what check(Inertia) refuses;
  // the message gives the number of the link or variable.
  static Result<Mechanism> make(std::span<const Drive> drives, std::span<const Link> links, int tip_link,
                                const Pose& X_LT);

  [[nodiscard]] std::size_t variable_count() const CELL_RT { return variable_count_; }
  [[nodiscard]] std::span<const Link> links() const CELL_RT { return {links_.data(), link_count_}; }
  [[nodiscard]] const LinkMotion& motion(std::size_t link) const CELL_RT { return motions_[link]; }
  [[nodiscard]] const Drive& drive(std::size_t variable) const CELL_RT { return drives_[variable]; }
  [[nodiscard]] int tip_link() const CELL_RT { return tip_link_; }  // that carries the TCP; -1: none does
  [[nodiscard]] const Pose& X_LT() const CELL_RT { return X_LT_; }  // TCP in that link's joint frame
  [[nodiscard]] double moving_mass() const CELL_RT;                 // kg
  // Something of `inertia` (in the TCP's frame) held at the TCP besides. Refused: what check(Inertia) refuses.
  [[nodiscard]] Result<Mechanism> with_payload(const Inertia& inertia) const;

 private:
  Mechanism() = default;
  std::size_t variable_count_ = 0;
  std::size_t link_count_ = 0;
  std::array<Link, kMaxLinks> links_{};
  std::array<LinkMotion, kMaxLinks> motions_{};
  std::array<Drive, kMaxJointsPerRobot> drives_{};
  int tip_link_ = -1;
  Pose X_LT_ = Pose::Identity();
};

}  // namespace cellmirror::dynamics
