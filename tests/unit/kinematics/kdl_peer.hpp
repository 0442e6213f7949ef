// Orocos KDL on the same URDF, read by urdfdom: independent of our reader and of our kinematics.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

class KdlChain {
 public:
  // Throws where KDL or urdfdom refuse.
  KdlChain(const std::string& urdf, const std::string& base, const std::string& tip);
  ~KdlChain();

  [[nodiscard]] std::size_t joint_count() const;
  [[nodiscard]] Pose forward(std::span<const double> q);
  [[nodiscard]] Eigen::MatrixXd jacobian(std::span<const double> q);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace cellmirror
