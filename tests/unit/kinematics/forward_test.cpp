#include "rt_core/kinematics/forward.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "rt_core/kinematics/sincos.hpp"
#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/kinematics/chain_support.hpp"

namespace cellmirror::kinematics {
namespace {

using Eigen::Vector3d;

constexpr double kExact = 1e-14;

// --- Closed forms.

TEST(PlanarArm, ofTwoLinksStandsWhereTheFormulaSays) {
  const DhRow rows[] = {{0.7, 0, 0, 0}, {0.4, 0, 0, 0}};
  const Chain sut = chain_of_table(rows);
  for (const double a : {-2.0, 0.0, 0.3, 1.7}) {
    for (const double b : {-1.0, 0.0, 2.5}) {
      const double q[] = {a, b};
      Jacobian jacobian;
      const Pose X = forward(sut, q, jacobian);
      EXPECT_NEAR(X.translation().x(), 0.7 * std::cos(a) + 0.4 * std::cos(a + b), kExact);
      EXPECT_NEAR(X.translation().y(), 0.7 * std::sin(a) + 0.4 * std::sin(a + b), kExact);
      EXPECT_NEAR(std::remainder(std::atan2(X(1, 0), X(0, 0)) - (a + b), 2 * std::numbers::pi), 0, kExact);
      // Its determinant in the plane: l1 l2 sin(b). Siciliano et al., Robotics, 3.3.
      EXPECT_NEAR((jacobian.topRows<2>().determinant()), 0.7 * 0.4 * std::sin(b), kExact);
      EXPECT_EQ(jacobian.cols(), 2);
      EXPECT_NEAR((jacobian.row(5) - Eigen::RowVector2d(1, 1)).norm(), 0, kExact);
    }
  }
}

TEST(PlanarArm, ofThreeLinksHasTheTextbookJacobian) {
  const DhRow rows[] = {{0.5, 0, 0, 0}, {0.3, 0, 0, 0}, {0.2, 0, 0, 0}};
  const Chain sut = chain_of_table(rows);
  const double q[] = {0.4, -1.1, 2.3};
  Jacobian jacobian;
  (void)forward(sut, q, jacobian);
  const double s1 = std::sin(q[0]);
  const double s12 = std::sin(q[0] + q[1]);
  const double s123 = std::sin(q[0] + q[1] + q[2]);
  EXPECT_NEAR(jacobian(0, 0), -0.5 * s1 - 0.3 * s12 - 0.2 * s123, kExact);
  EXPECT_NEAR(jacobian(0, 1), -0.3 * s12 - 0.2 * s123, kExact);
  EXPECT_NEAR(jacobian(0, 2), -0.2 * s123, kExact);
}

TEST(SphericalWrist, turnsAsEulerAnglesAndIsSingularWhenStraight) {
  // z, y, z about one point.
  const DhRow rows[] = {{0, -90 * kDeg, 0, 0}, {0, 90 * kDeg, 0, 0}, {0, 0, 0, 0}};
  const Chain sut = chain_of_table(rows);
  const double q[] = {0.7, -1.2, 2.9};
  const Pose expected = turn(q[0], Vector3d::UnitZ()) * turn(q[1], Vector3d::UnitY()) * turn(q[2], Vector3d::UnitZ());
  Jacobian jacobian;
  EXPECT_LT(difference(forward(sut, q, jacobian), expected), kExact);
  EXPECT_LT(jacobian.topRows<3>().cwiseAbs().maxCoeff(), kExact);
  EXPECT_GT(std::abs(jacobian.bottomRows<3>().determinant()), 0.5);
  const double straight[] = {0.7, 0, 2.9};
  (void)forward(sut, straight, jacobian);
  EXPECT_NEAR(jacobian.bottomRows<3>().determinant(), 0, kExact);
}

// Corke, Armstrong-Helouvry 1994, and the poses that Corke's Robotics Toolbox prints for it (rounded to 0.1 mm), there
// without the height of the base, 0.672 m.
struct Puma560 : testing::Test {
  static constexpr double kBase = 0.672;
  static Chain make() {
    const DhRow rows[] = {{0, 90 * kDeg, kBase, 0},  {0.4318, 0, 0, 0},     {0.0203, -90 * kDeg, 0.15005, 0},
                          {0, 90 * kDeg, 0.4318, 0}, {0, -90 * kDeg, 0, 0}, {0, 0, 0, 0}};
    return chain_of_table(rows);
  }
  Pose at(double q1, double q2, double q3, double q4, double q5, double q6) const {
    const double q[] = {q1 * kDeg, q2 * kDeg, q3 * kDeg, q4 * kDeg, q5 * kDeg, q6 * kDeg};
    return forward(sut, q);
  }
  Chain sut = make();
};

TEST_F(Puma560, atZeroIsAnL) {
  const Pose X = at(0, 0, 0, 0, 0, 0);
  EXPECT_LT((X.linear() - Eigen::Matrix3d::Identity()).norm(), kExact);
  EXPECT_LT((X.translation() - Vector3d(0.4521, -0.15005, kBase + 0.4318)).norm(), kExact);
}

TEST_F(Puma560, readyStandsUpright) {
  const Pose X = at(0, 90, -90, 0, 0, 0);
  EXPECT_LT((X.linear() - Eigen::Matrix3d::Identity()).norm(), kExact);
  EXPECT_LT((X.translation() - Vector3d(0.0203, -0.15005, kBase + 0.8636)).norm(), kExact);
}

TEST_F(Puma560, nominalLooksForward) {
  const Pose X = at(0, 45, 180, 0, 45, 0);
  Eigen::Matrix3d R;
  R << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  constexpr double kPrinted = 1e-4;
  EXPECT_LT((X.linear() - R).cwiseAbs().maxCoeff(), kExact);
  EXPECT_LT((X.translation() - Vector3d(0.5963, -0.1501, kBase - 0.0144)).cwiseAbs().maxCoeff(), kPrinted);
}

// Manutec r3: y up, the axes y, x, x, y, x, y; straight up at zero; 0.5 m from axis 2 to 3, 0.73 m on to the wrist.
TEST(ManutecR3, movesAsTheProductOfItsTurns) {
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const Vector3d axes[] = {y, x, x, y, x, y};
  const Vector3d ways[] = {{0, 0, 0}, {0, 0, 0}, {0, 0.5, 0}, {0, 0, 0}, {0, 0.73, 0}, {0, 0, 0}};
  std::vector<ChainJoint> joints;
  Pose back = Pose::Identity();  // from the frame along z to the one of the axes
  for (std::size_t i = 0; i < 6; ++i) {
    const Pose X_AZ(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ().cross(axes[i])));
    joints.push_back({back * Pose(Eigen::Translation3d(ways[i])) * X_AZ, JointKind::revolute,
                      static_cast<std::uint8_t>(i), 1.0, 0.0});
    back = X_AZ.inverse();
  }
  const Chain sut = chain_of(std::move(joints), 6, back);
  const double zero[6] = {};
  EXPECT_LT((forward(sut, zero).translation() - Vector3d(0, 1.23, 0)).norm(), kExact);
  const double q[] = {0.8, -0.6, 1.1, 2.0, -0.9, 0.4};
  const Pose X = forward(sut, q);
  const double s2 = std::sin(q[1]), c2 = std::cos(q[1]), s23 = std::sin(q[1] + q[2]), c23 = std::cos(q[1] + q[2]);
  const double out = 0.5 * s2 + 0.73 * s23;  // along z before the first axis turns
  const Vector3d wrist(out * std::sin(q[0]), 0.5 * c2 + 0.73 * c23, out * std::cos(q[0]));
  EXPECT_LT((X.translation() - wrist).norm(), kExact);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < 6; ++i) R = R * Eigen::AngleAxisd(q[i], axes[i]);
  EXPECT_LT((X.linear() - R).cwiseAbs().maxCoeff(), kExact);
}

// --- Properties.

struct AllSizes : testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Joints, AllSizes, testing::Range(std::size_t{1}, std::size_t{17}));

TEST_P(AllSizes, poseIsTheProductOfThePosesOfTheJoints) {
  std::mt19937_64 random(GetParam());
  for (int i = 0; i < 50; ++i) {
    for (const bool plain : {true, false}) {
      const Chain sut = random_chain(GetParam(), plain, random);
      const auto q = random_values(sut.variable_count(), 10.0, random);
      // A prismatic mimic of a mimic's way may be long, so rounding is larger than 1e-15.
      EXPECT_LT(difference(forward(sut, q), plain_product(sut, q)), 1e-12);
      Jacobian jacobian;
      EXPECT_LT(difference(forward(sut, q, jacobian), plain_product(sut, q)), 1e-12);
    }
  }
}

TEST_P(AllSizes, jacobianIsTheLimitOfDifferences) {
  std::mt19937_64 random(100 + GetParam());
  for (int i = 0; i < 20; ++i) {
    for (const bool plain : {true, false}) {
      const Chain sut = random_chain(GetParam(), plain, random);
      const auto q = random_values(sut.variable_count(), 2.0, random);
      Jacobian jacobian;
      (void)forward(sut, q, jacobian);
      EXPECT_LT((jacobian - jacobian_by_differences(sut, q)).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST_P(AllSizes, allInstructionSetsAgree) {
  const auto kernels = baseline::forward_kernels();
  const std::size_t size = GetParam() < ForwardKernels::kSizes ? GetParam() : 0;
  std::mt19937_64 random(200 + GetParam());
  for (const bool plain : {true, false}) {
    const Chain sut = random_chain(GetParam(), plain, random);
    const auto q = random_values(sut.variable_count(), 3.0, random);
    Jacobian chosen;
    const Pose X_BT = forward(sut, q, chosen);
    Jacobian jacobian = chosen * 0;
    Pose X;
    kernels.pose_and_jacobian[size](sut.forward_constants(), q.data(), X.data(), jacobian.data());
    EXPECT_LT(difference(X, X_BT), 1e-13);
    EXPECT_LT((jacobian - chosen).cwiseAbs().maxCoeff(), 1e-13);
    kernels.pose[size](sut.forward_constants(), q.data(), X.data(), nullptr);
    EXPECT_LT(difference(X, X_BT), 1e-13);
  }
}

TEST(Forward, ofMoreJointsThanVariablesMovesMimicsAlong) {
  std::mt19937_64 random(7);
  const Chain sut = random_chain(kMaxChainJoints, false, random);
  const auto q = random_values(sut.variable_count(), 1.0, random);
  EXPECT_EQ(sut.variable_count(), kMaxVariables);
  EXPECT_LT(difference(forward(sut, q), plain_product(sut, q)), 1e-11);
}

TEST(Forward, ofFixedSizeGivesTheSame) {
  std::mt19937_64 random(8);
  const Chain sut = random_chain(7, true, random);
  const auto q = random_values(7, 3.0, random);
  Jacobian expected;
  const Pose X_BT = forward(sut, q, expected);
  Eigen::Matrix<double, 6, 7> jacobian;
  EXPECT_EQ(difference(forward<7>(sut, std::span<const double, 7>(q.data(), 7), jacobian), X_BT), 0);
  EXPECT_EQ((jacobian - expected).cwiseAbs().maxCoeff(), 0);
}

// Twists on the way from joint to joint that are just not parallel or just not opposite.
TEST(Forward, keepsItsAccuracyNearParallelAxes) {
  std::mt19937_64 random(9);
  for (const double slant : {0.0, 1e-300, 1e-17, 1e-12, 1e-8, 1e-5}) {
    for (const double half : {0.0, std::numbers::pi}) {
      std::vector<ChainJoint> joints;
      for (std::uint8_t i = 0; i < 6; ++i) {
        const Pose X = translation(0.3, 0.1, 0.2) * turn(half + slant, Vector3d::UnitX()) * turn(i, Vector3d::UnitZ());
        joints.push_back({X, JointKind::revolute, i, 1.0, 0.0});
      }
      const Chain sut = chain_of(std::move(joints), 6, translation(0, 0, 0.1));
      const auto q = random_values(6, 3.0, random);
      EXPECT_LT(difference(forward(sut, q), plain_product(sut, q)), kExact) << slant << " " << half;
    }
  }
}

TEST(Forward, takesAnglesOfAnySize) {
  const DhRow rows[] = {{0.7, 0, 0, 0}, {0.4, 0, 0, 0}};
  const Chain sut = chain_of_table(rows);
  const double q[] = {1e9, -3e5};
  EXPECT_NEAR(forward(sut, q).translation().x(), 0.7 * std::cos(1e9) + 0.4 * std::cos(1e9 - 3e5), kExact);
}

TEST(Forward, ofValuesThatAreNotFiniteIsNotFinite) {
  std::mt19937_64 random(10);
  const Chain sut = random_chain(6, true, random);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 6; ++i) {
      auto q = random_values(6, 1.0, random);
      q[i] = bad;
      EXPECT_FALSE(forward(sut, q).matrix().allFinite());
    }
  }
}

TEST(Forward, leavesTheHeapAlone) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  std::mt19937_64 random(11);
  const Chain sut = random_chain(16, false, random);
  const auto q = random_values(sut.variable_count(), 1.0, random);
  Jacobian jacobian;
  const AllocationGuard guard;
  (void)forward(sut, q);
  const Pose X_BT = forward(sut, q, jacobian);
  (void)pose_error(X_BT, Pose::Identity());
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(PoseError, leadsFromOnePoseToTheOther) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 200; ++i) {
    const Pose a = random_pose(random);
    const Pose b = random_pose(random);
    const Twist sut = pose_error(a, b);
    const Vector3d w = sut.tail<3>();
    EXPECT_LT((a.translation() + sut.head<3>() - b.translation()).norm(), kExact);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(w.norm(), w.normalized()) * a.linear();
    EXPECT_LT((R - b.linear()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE(w.norm(), std::numbers::pi + kExact);
  }
}

TEST(SinesOfFour, areExactToTheLastBits) {
  std::mt19937_64 random(13);
  for (const double largest : {1e-3, 1.0, 10.0, 1e3, kLargestAngle}) {
    for (int i = 0; i < 20'000; ++i) {
      const auto angles = random_values(4, largest, random);
      double sine[4];
      double cosine[4];
      sincos_of(angles.data(), 4, sine, cosine);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_NEAR(sine[k], static_cast<double>(std::sin(static_cast<long double>(angles[k]))), 4e-16);
        ASSERT_NEAR(cosine[k], static_cast<double>(std::cos(static_cast<long double>(angles[k]))), 4e-16);
      }
    }
  }
}

TEST(SinesOfFour, ofQuartersAreWhereTheyBelong) {
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const double angle[4] = {quarter * std::numbers::pi / 2, 0, -0.0, 1e300};
    double sine[4];
    double cosine[4];
    sincos_of(angle, 4, sine, cosine);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(sine[k], std::sin(angle[k]), 1e-15) << quarter;
      EXPECT_NEAR(cosine[k], std::cos(angle[k]), 1e-15) << quarter;
    }
  }
}

}  // namespace
}  // namespace cellmirror::kinematics
