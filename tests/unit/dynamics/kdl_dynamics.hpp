// Inverse dynamics of Orocos KDL on a URDF, read by urdfdom.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cellmirror::dynamics {

class KdlDynamics {
 public:
  // The chain from base to tip with the masses of its links. Throws where KDL or urdfdom refuse.
  KdlDynamics(const std::string& urdf, const std::string& base, const std::string& tip);
  ~KdlDynamics();
  KdlDynamics(KdlDynamics&&) noexcept;

  [[nodiscard]] std::size_t joint_count() const;
  // Gravity -9.80665 m/s2 along the base's z; force and torque of the surroundings on the tip, at its origin, in its
  // frame. Of the bare links: no friction, no rotors.
  void set(std::span<const double> q, std::span<const double> qd, std::span<const double> qdd);
  void compute(const Eigen::Vector3d& tip_force, const Eigen::Vector3d& tip_torque);
  [[nodiscard]] double effort(std::size_t joint) const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace cellmirror::dynamics
