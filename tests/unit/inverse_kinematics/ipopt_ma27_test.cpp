// The dense factorisation behind MA27's interface, against Eigen.
#include "rt_core/inverse_kinematics/ipopt_ma27.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <vector>

namespace cellmirror::inverse_kinematics {
namespace {

constexpr int kSingular = -5;

// Calls the four subroutines as Ipopt does: the lengths of the arrays are those that the analysis asks for.
class Factorisation {
 public:
  Factorisation(int n, std::vector<int> rows, std::vector<int> columns)
      : n_(n), nz_(static_cast<int>(rows.size())), rows_(std::move(rows)), columns_(std::move(columns)) {
    cellmirror_ma27id(icntl_, cntl_);
    std::vector<int> iw(2 * rows_.size() + 3 * static_cast<std::size_t>(n) + 1);
    std::vector<int> ikeep(3 * static_cast<std::size_t>(n));
    int liw = static_cast<int>(iw.size());
    int flag = 0;
    double ops = 0;
    std::vector<int> iw1(2 * static_cast<std::size_t>(n));
    cellmirror_ma27ad(&n_, &nz_, rows_.data(), columns_.data(), iw.data(), &liw, ikeep.data(), iw1.data(), &steps_,
                      &flag, icntl_, cntl_, info_, &ops);
    a_.resize(static_cast<std::size_t>(info_[4]));
    iw_.resize(static_cast<std::size_t>(info_[5]));
  }

  int factorise(const std::vector<double>& values) {
    std::fill(a_.begin(), a_.end(), 1e300);  // what an earlier factorisation left must not count
    std::copy(values.begin(), values.end(), a_.begin());
    int la = static_cast<int>(a_.size());
    int liw = static_cast<int>(iw_.size());
    cellmirror_ma27bd(&n_, &nz_, rows_.data(), columns_.data(), a_.data(), &la, iw_.data(), &liw, nullptr, &steps_,
                      &front_, nullptr, icntl_, cntl_, info_);
    return info_[0];
  }

  int flag_with(int la, int liw) {
    cellmirror_ma27bd(&n_, &nz_, rows_.data(), columns_.data(), a_.data(), &la, iw_.data(), &liw, nullptr, &steps_,
                      &front_, nullptr, icntl_, cntl_, info_);
    return info_[0];
  }

  [[nodiscard]] int negative() const { return info_[14]; }
  [[nodiscard]] int needed() const { return info_[1]; }

  Eigen::VectorXd solve(Eigen::VectorXd rhs) {
    int la = static_cast<int>(a_.size());
    int liw = static_cast<int>(iw_.size());
    cellmirror_ma27cd(&n_, a_.data(), &la, iw_.data(), &liw, nullptr, &front_, rhs.data(), nullptr, &steps_, icntl_,
                      cntl_);
    return rhs;
  }

 private:
  int n_;
  int nz_;
  std::vector<int> rows_;
  std::vector<int> columns_;
  std::vector<double> a_;
  std::vector<int> iw_;
  int icntl_[30] = {};
  double cntl_[5] = {};
  int info_[20] = {};
  int steps_ = 0;
  int front_ = 0;
};

// All places of the lower triangle, and some of the upper one: entries of the same place add up.
struct Triplets {
  explicit Triplets(int n) {
    for (int i = 1; i <= n; ++i) {
      for (int j = 1; j <= i; ++j) add(i, j);
    }
    for (int j = 2; j <= n; j += 2) add(1, j);
  }
  void add(int i, int j) {
    rows.push_back(i);
    columns.push_back(j);
  }
  [[nodiscard]] Eigen::MatrixXd matrix(int n, const std::vector<double>& values) const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < values.size(); ++k) {
      m(rows[k] - 1, columns[k] - 1) += values[k];
      if (rows[k] != columns[k]) m(columns[k] - 1, rows[k] - 1) += values[k];
    }
    return m;
  }
  std::vector<int> rows;
  std::vector<int> columns;
};

TEST(DenseMa27, SolvesRandomIndefiniteMatricesAndCountsTheirNegativeEigenvalues) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> number(0.0, 1.0);
  for (int n = 1; n <= 24; ++n) {
    const Triplets places(n);
    Factorisation sut(n, places.rows, places.columns);
    for (int round = 0; round < 40; ++round) {
      std::vector<double> values(places.rows.size());
      for (double& value : values) value = number(random);
      const Eigen::MatrixXd m = places.matrix(n, values);
      ASSERT_EQ(sut.factorise(values), 0);
      const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues();
      EXPECT_EQ(sut.negative(), (eigenvalues.array() < 0).count()) << n;
      const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return number(random); });
      const double condition = eigenvalues.cwiseAbs().maxCoeff() / eigenvalues.cwiseAbs().minCoeff();
      EXPECT_LT((sut.solve(m * x) - x).norm(), 1e-13 * n * condition * x.norm());
    }
  }
}

// The matrices of interior points: rows of 1e10 beside rows of 1, zeros on the diagonal of the equations.
TEST(DenseMa27, KeepsTheInertiaOfBadlyScaledSaddlePoints) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> number(0.0, 1.0);
  std::uniform_real_distribution<double> exponent(-4.0, 10.0);
  for (int round = 0; round < 200; ++round) {
    const int n = 7;
    const int m = 1 + round % 6;
    const Triplets places(n + m);
    std::vector<double> values(places.rows.size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const bool equation = places.rows[k] > n;
      if (places.columns[k] > n || places.rows[k] < places.columns[k]) continue;
      if (equation) values[k] = number(random);
      if (places.rows[k] == places.columns[k]) values[k] = std::pow(10.0, exponent(random));
    }
    Factorisation sut(n + m, places.rows, places.columns);
    ASSERT_EQ(sut.factorise(values), 0);
    EXPECT_EQ(sut.negative(), m);  // a positive definite block over m independent equations
    const Eigen::MatrixXd kkt = places.matrix(n + m, values);
    const Eigen::VectorXd rhs = Eigen::VectorXd::Ones(n + m);
    EXPECT_LT((kkt * sut.solve(rhs) - rhs).norm(), 1e-5);
  }
}

TEST(DenseMa27, FlagsSingularMatrices) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> number(0.0, 1.0);
  for (int n = 1; n <= 12; ++n) {
    const Triplets places(n);
    Factorisation sut(n, places.rows, places.columns);
    EXPECT_EQ(sut.factorise(std::vector<double>(places.rows.size(), 0.0)), kSingular);
    // Of rank n - 1.
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n - 1, [&](auto, auto) { return number(random); });
    const Eigen::MatrixXd m = half * half.transpose();
    std::vector<double> values(places.rows.size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (places.rows[k] >= places.columns[k]) values[k] = m(places.rows[k] - 1, places.columns[k] - 1);
    }
    EXPECT_EQ(sut.factorise(values), kSingular) << n;
  }
}

TEST(DenseMa27, FlagsNumbersThatAreNotFinite) {
  const Triplets places(3);
  Factorisation sut(3, places.rows, places.columns);
  std::vector<double> values(places.rows.size(), 1.0);
  values[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sut.factorise(values), kSingular);
  values[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sut.factorise(values), kSingular);
}

TEST(DenseMa27, RefusesWorkArraysThatAreTooShortAndSaysTheLength) {
  const Triplets places(4);
  Factorisation sut(4, places.rows, places.columns);
  EXPECT_EQ(sut.flag_with(1 << 20, 3), -3);
  EXPECT_EQ(sut.needed(), 4);
  EXPECT_EQ(sut.flag_with(20, 4), -4);
  EXPECT_GT(sut.needed(), 20);
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
