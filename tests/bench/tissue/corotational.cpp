#include "tests/bench/tissue/corotational.hpp"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <cmath>
#include <utility>

namespace cellmirror::tissue_bench {
namespace {

constexpr double kTolerance = 1e-4;
constexpr int kMostIterations = 200;

// Turns q until it fits the deformation best (Mueller, Bender, Chentanez, Macklin 2016); it begins near.
void follow(Eigen::Quaterniond& q, const Eigen::Matrix3d& f) {
  for (int i = 0; i < 4; ++i) {
    const Eigen::Matrix3d r = q.toRotationMatrix();
    const Eigen::Vector3d moment = r.col(0).cross(f.col(0)) + r.col(1).cross(f.col(1)) + r.col(2).cross(f.col(2));
    const double weight = std::abs(r.col(0).dot(f.col(0)) + r.col(1).dot(f.col(1)) + r.col(2).dot(f.col(2))) + 1e-9;
    const Eigen::Vector3d turn = moment / weight;
    const double angle = turn.norm();
    if (angle < 1e-6) return;
    q = (Eigen::AngleAxisd(angle, turn / angle) * q).normalized();
  }
}

}  // namespace

Corotational::Corotational(std::vector<Eigen::Vector3d> nodes, std::vector<std::array<std::uint32_t, 4>> tetrahedra,
                           const tissue::Material& material, std::vector<std::uint8_t> fixed)
    : rest_(std::move(nodes)), x_(rest_), fixed_(std::move(fixed)), material_(material) {
  const auto size = static_cast<Eigen::Index>(3 * rest_.size());
  mass_ = v_ = force_ = Eigen::VectorXd::Zero(size);
  const double e = material.youngs_modulus_pa;
  const double nu = material.poissons_ratio;
  const double lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
  const double mu = e / (2 * (1 + nu));
  std::vector<Eigen::Triplet<double>> pattern;
  for (const auto& t : tetrahedra) {
    Element element;
    element.nodes = t;
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = rest_[t[static_cast<std::size_t>(k) + 1]] - rest_[t[0]];
    element.inverse_shape = edges.inverse();
    const double volume = std::abs(edges.determinant()) / 6.0;
    Eigen::Matrix<double, 4, 3> slopes;
    slopes.bottomRows<3>() = element.inverse_shape;
    slopes.row(0) = -element.inverse_shape.colwise().sum();
    for (int a = 0; a < 4; ++a) {
      mass_.segment<3>(3 * static_cast<Eigen::Index>(t[static_cast<std::size_t>(a)])).array() +=
          0.25 * volume * material.density_kg_m3;
      for (int b = 0; b < 4; ++b) {
        const Eigen::Vector3d ga = slopes.row(a);
        const Eigen::Vector3d gb = slopes.row(b);
        element.stiffness.block<3, 3>(3 * a, 3 * b) =
            volume *
            (lambda * ga * gb.transpose() + mu * gb * ga.transpose() + mu * ga.dot(gb) * Eigen::Matrix3d::Identity());
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            pattern.emplace_back(3 * t[static_cast<std::size_t>(a)] + static_cast<unsigned>(r),
                                 3 * t[static_cast<std::size_t>(b)] + static_cast<unsigned>(c), 1.0);
          }
        }
      }
    }
    elements_.push_back(element);
  }
  matrix_.resize(size, size);
  matrix_.setFromTriplets(pattern.begin(), pattern.end());
  for (Element& element : elements_) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(element.nodes[a]);
        element.block[4 * a + b] = &matrix_.coeffRef(row, 3 * static_cast<Eigen::Index>(element.nodes[b])) -
                                   matrix_.valuePtr() - matrix_.outerIndexPtr()[row];
      }
    }
  }
}

// M + (damping dt + dt^2) K, and the elastic forces.
void Corotational::assemble(double dt) {
  const double factor = dt * (dt + material_.damping_s);
  double* const values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  force_.setZero();
  for (Element& element : elements_) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
      edges.col(k) = x_[element.nodes[static_cast<std::size_t>(k) + 1]] - x_[element.nodes[0]];
    }
    follow(element.turn, edges * element.inverse_shape);
    const Eigen::Matrix3d r = element.turn.toRotationMatrix();
    Eigen::Matrix<double, 12, 1> back;  // displacements in the element's own directions
    for (int a = 0; a < 4; ++a) {
      const std::uint32_t n = element.nodes[static_cast<std::size_t>(a)];
      back.segment<3>(3 * a) = r.transpose() * x_[n] - rest_[n];
    }
    const Eigen::Matrix<double, 12, 1> f = element.stiffness * back;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto row = static_cast<Eigen::Index>(3 * element.nodes[a]);
      force_.segment<3>(row) -= r * f.segment<3>(3 * static_cast<Eigen::Index>(a));
      for (std::size_t b = 0; b < 4; ++b) {
        const Eigen::Matrix3d k =
            factor * r *
            element.stiffness.block<3, 3>(3 * static_cast<Eigen::Index>(a), 3 * static_cast<Eigen::Index>(b)) *
            r.transpose();
        for (Eigen::Index i = 0; i < 3; ++i) {
          double* const at = values + matrix_.outerIndexPtr()[row + i] + element.block[4 * a + b];
          for (Eigen::Index j = 0; j < 3; ++j) at[j] += k(i, j);
        }
      }
    }
  }
  for (Eigen::Index i = 0; i < mass_.size(); ++i) {
    // A fixed node is one of unbounded mass.
    matrix_.coeffRef(i, i) += fixed_[static_cast<std::size_t>(i / 3)] != 0 ? 1e12 * mass_[i] : mass_[i];
  }
}

int Corotational::step(double dt, const Eigen::Vector3d& gravity) {
  assemble(dt);
  Eigen::VectorXd right = mass_.cwiseProduct(v_) / (1.0 + material_.drag_1_s * dt) + dt * force_;
  for (std::size_t n = 0; n < x_.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    if (fixed_[n] != 0) {
      right.segment<3>(at).setZero();
    } else {
      right.segment<3>(at) += dt * mass_[at] * gravity;
    }
  }
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  solver.compute(matrix_);
  v_ = solver.solveWithGuess(right, v_);
  for (std::size_t n = 0; n < x_.size(); ++n) x_[n] += dt * v_.segment<3>(static_cast<Eigen::Index>(3 * n));
  return static_cast<int>(solver.iterations());
}

}  // namespace cellmirror::tissue_bench
