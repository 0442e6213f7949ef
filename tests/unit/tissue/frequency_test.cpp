// Frequencies of the first modes of a free body against the eigenvalues of its stiffness and mass, which are assembled
// here from the linear law in doubles.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

struct Modes {
  Eigen::VectorXd omega;  // rad/s, rising, without the six rigid ones
  Eigen::MatrixXd shape;  // columns
  Eigen::VectorXd mass;   // kg, by component
};

Modes modes_of(const ObjectDescription& d) {
  const TetraMesh& mesh = d.volume;
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodes.size());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size, size);
  Modes modes;
  modes.mass = Eigen::VectorXd::Zero(size);
  const double e = d.material.youngs_modulus_pa;
  const double nu = d.material.poissons_ratio;
  const double lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
  const double mu = e / (2 * (1 + nu));
  Eigen::Matrix<double, 6, 6> law = Eigen::Matrix<double, 6, 6>::Zero();
  law.topLeftCorner<3, 3>().setConstant(lambda);
  law.diagonal() << lambda + 2 * mu, lambda + 2 * mu, lambda + 2 * mu, mu, mu, mu;
  for (const auto& t : mesh.tetrahedra) {
    Eigen::Matrix4d corners;
    for (int n = 0; n < 4; ++n) corners.col(n) << 1.0, mesh.nodes[t[static_cast<std::size_t>(n)]];
    const double volume = std::abs(corners.determinant()) / 6.0;
    const Eigen::Matrix4d slopes = corners.inverse();  // row n: the shape function of corner n
    Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
    for (int n = 0; n < 4; ++n) {
      const double x = slopes(n, 1);
      const double y = slopes(n, 2);
      const double z = slopes(n, 3);
      b.block<6, 3>(0, 3 * n) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, z, 0, x, 0, z, y;
    }
    const Eigen::Matrix<double, 12, 12> element = volume * b.transpose() * law * b;
    for (int n = 0; n < 4; ++n) {
      const auto row = static_cast<Eigen::Index>(3 * t[static_cast<std::size_t>(n)]);
      modes.mass.segment<3>(row).array() += 0.25 * volume * d.material.density_kg_m3;
      for (int m = 0; m < 4; ++m) {
        k.block<3, 3>(row, static_cast<Eigen::Index>(3 * t[static_cast<std::size_t>(m)])) +=
            element.block<3, 3>(3 * n, 3 * m);
      }
    }
  }
  const Eigen::VectorXd root = modes.mass.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(root.asDiagonal() * k * root.asDiagonal());
  EXPECT_LT(solved.eigenvalues()[5], 1e-6 * solved.eigenvalues()[6]);
  modes.omega = solved.eigenvalues().tail(size - 6).cwiseSqrt();
  modes.shape = root.asDiagonal() * solved.eigenvectors().rightCols(size - 6);
  return modes;
}

// rad/s: the body is pushed in the mode's shape, and the crossings of zero of its part in the motion are counted.
double measured(Body& body, const std::vector<std::uint32_t>& order, const Modes& modes, Eigen::Index mode) {
  const double dt = 0.25 * step_of(body);
  const Eigen::VectorXd shape = modes.shape.col(mode);
  const Eigen::VectorXd weights = modes.mass.cwiseProduct(shape);
  const std::vector<Eigen::Vector3d> start(body.positions().begin(), body.positions().end());
  const double push = 2e-5 * modes.omega[mode] / shape.cwiseAbs().maxCoeff();  // some 20 um
  for (std::uint32_t n = 0; n < start.size(); ++n) body.add_velocity(n, push * shape.segment<3>(3 * order[n]));
  std::vector<double> crossings;
  double before = 0;
  for (int i = 0; crossings.size() < 9 && i < 400'000; ++i) {
    body.begin_step(dt, Eigen::Vector3d::Zero());
    body.end_step(dt);
    double part = 0;
    for (std::size_t n = 0; n < start.size(); ++n) {
      part += weights.segment<3>(3 * order[n]).dot(body.positions()[n] - start[n]);
    }
    if (i > 0 && (part < 0) != (before < 0)) crossings.push_back(dt * (i - part / (part - before)));
    before = part;
  }
  if (crossings.size() < 9) return 0;
  return std::numbers::pi * 8.0 / (crossings.back() - crossings.front());
}

TEST(TissueFrequencies, AreThoseOfTheEigenproblem) {
  ObjectDescription d = block(Eigen::Vector3d(0.06, 0.03, 0.02), {6, 3, 2});
  d.material.damping_s = 0;
  d.material.drag_1_s = 0;
  const Modes modes = modes_of(d);
  Body first = made(d);
  std::vector<std::uint32_t> order;  // node of the mesh by node of the body
  for (const Eigen::Vector3d& p : first.positions()) {
    const auto at =
        std::ranges::find_if(d.volume.nodes, [&](const Eigen::Vector3d& q) { return (p - q).norm() < 1e-9; });
    ASSERT_NE(at, d.volume.nodes.end());
    order.push_back(static_cast<std::uint32_t>(at - d.volume.nodes.begin()));
  }
  for (Eigen::Index mode = 0; mode < 6; ++mode) {
    Body body = made(d);
    EXPECT_NEAR(measured(body, order, modes, mode) / modes.omega[mode], 1.0, 0.02) << mode;
  }
  // And the fastest one, which bounds the step.
  const double limit = 2.0 / modes.omega[modes.omega.size() - 1];
  EXPECT_NEAR(first.stable_step_s(), limit, 0.05 * limit);
  EXPECT_LT(step_of(first), limit);
}

}  // namespace
}  // namespace cellmirror::tissue
