// MuJoCo on the same URDF, read by its own reader.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

class MujocoChain {
 public:
  // `joints`: the names of the joints of the values. Throws where MuJoCo refuses.
  MujocoChain(const std::string& urdf, const std::string& base, const std::string& tip,
              const std::vector<std::string>& joints);
  ~MujocoChain();

  void move_to(std::span<const double> q);
  // At the last posture.
  [[nodiscard]] Pose pose() const;
  [[nodiscard]] Eigen::MatrixXd jacobian() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace cellmirror
