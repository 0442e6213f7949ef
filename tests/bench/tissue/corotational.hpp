// The other way to simulate soft tissue, for comparison: linear elements that turn with the material (corotational) and
// one implicit step of a millisecond, solved by conjugate gradients (Mueller, Gross 2004; Baraff, Witkin 1998). Written
// plainly, one thread.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue_bench {

class Corotational {
 public:
  // `fixed` by node. Positions at rest.
  Corotational(std::vector<Eigen::Vector3d> nodes, std::vector<std::array<std::uint32_t, 4>> tetrahedra,
               const tissue::Material& material, std::vector<std::uint8_t> fixed);

  // Returns the iterations that the solver took to a residual of 1e-4 of the right side.
  int step(double dt, const Eigen::Vector3d& gravity);
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions() const { return x_; }

 private:
  struct Element {
    std::array<std::uint32_t, 4> nodes{};
    Eigen::Matrix3d inverse_shape;
    Eigen::Matrix<double, 12, 12> stiffness;
    std::array<Eigen::Index, 16> block{};  // where the first value of each 3 x 3 block lies, in rows of its node
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  };

  void assemble(double dt);

  std::vector<Eigen::Vector3d> rest_;
  std::vector<Eigen::Vector3d> x_;
  std::vector<Element> elements_;
  std::vector<std::uint8_t> fixed_;
  tissue::Material material_;
  Eigen::VectorXd mass_;
  Eigen::VectorXd v_;
  Eigen::VectorXd force_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
};

}  // namespace cellmirror::tissue_bench
