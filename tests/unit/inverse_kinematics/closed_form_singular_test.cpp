// Targets at which joints are free or branches meet, targets at and beyond the border of reach, and arms that only
// nearly have the arrangement of a family.
#include <gtest/gtest.h>

#include <limits>

#include "closed_form_checks.hpp"
#include "rt_core/kinematics/fast_step.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;

// All postures for the pose of q are exact, and there is one.
Found expect_exact(const kinematics::Chain& chain, const JointValues& q, const JointValues& near, double tolerance) {
  const auto sut = ClosedForm::analyse(chain);
  EXPECT_TRUE(sut);
  if (!sut) return {};
  const Pose X_BG = kinematics::forward(chain, q);
  const Found found = solve(*sut, X_BG, near);
  EXPECT_FALSE(found.empty());
  for (const JointValues& p : found) EXPECT_LE(error_of(chain, p, X_BG), tolerance);
  return found;
}

JointValues with(JointValues q, std::size_t joint, double value) {
  q[joint] = value;
  return q;
}

constexpr JointValues kUsual{0.3, 0.4, -0.9, 0.7, 0.8, -0.5};

TEST(ClosedFormSingular, StraightWristKeepsTheFourthJointOfTheNearPosture) {
  for (const kinematics::Chain& chain : {puma_560(), manutec_r3()}) {
    for (const double fifth : {0.0, kPi}) {
      const JointValues q = with(kUsual, 4, fifth);
      const Found found = expect_exact(chain, q, q, 1e-9);
      EXPECT_LT(nearest_distance(found, q), 1e-6);
    }
  }
}

TEST(ClosedFormSingular, NearlyStraightWristIsExactToo) {
  for (const double fifth : {1e-3, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-15}) {
    SCOPED_TRACE(fifth);
    const JointValues q = with(kUsual, 4, fifth);
    expect_exact(puma_560(), q, q, 1e-9);
    expect_exact(ur_5(), q, q, 1e-9);
    expect_exact(puma_560(), with(kUsual, 4, kPi - fifth), {}, 1e-9);
  }
}

// Nothing but q brings exactly this wrist; the joints that it leaves free come from the near posture, any that it is.
TEST(ClosedFormSingular, AnyNearPostureIsTaken) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    expect_exact(puma_560(), with(random_posture(puma_560(), random), 4, 0), random.posture(), 1e-9);
    expect_exact(ur_5(), with(random_posture(ur_5(), random), 4, i % 2 == 0 ? 0 : kPi), random.posture(), 1e-9);
  }
}

TEST(ClosedFormSingular, WristOverTheFirstAxisKeepsTheFirstJointOfTheNearPosture) {
  // The wrist of the r3 stands over axis 1 where the arm is straight up, and where elbow and shoulder balance.
  const kinematics::Chain chain = manutec_r3();
  const auto balanced = [](double elbow) { return std::atan2(0.73 * std::sin(elbow), 0.5 + 0.73 * std::cos(elbow)); };
  for (const double elbow : {0.5, -1.2, 2.0}) {
    JointValues q{0.6, -balanced(elbow), elbow, 0.7, 0.8, -0.5};
    const Vector wrist = kinematics::forward(chain, q) * Vector(0, 0, -0.25);
    ASSERT_LT(wrist.head<2>().norm(), 1e-12);
    const Found found = expect_exact(chain, q, q, 1e-9);
    EXPECT_LT(nearest_distance(found, q), 1e-6);
  }
}

TEST(ClosedFormSingular, StretchedElbowGivesAPosture) {
  for (const double bend : {0.0, 1e-9, 1e-7, 1e-5}) {
    SCOPED_TRACE(bend);
    expect_exact(manutec_r3(), with(kUsual, 2, bend), {}, 1e-9);
    expect_exact(ur_5(), with(kUsual, 2, bend), {}, 1e-9);
    expect_exact(ur_5(), with(kUsual, 2, kPi - bend), {}, 1e-9);
  }
}

TEST(ClosedFormSingular, AllSingularitiesAtOnceGiveAPosture) {
  for (const kinematics::Chain& chain : {manutec_r3(), puma_560(), ur_5()}) expect_exact(chain, {}, {}, 1e-9);
}

TEST(ClosedFormBorder, ATargetBeyondReachByAHairGivesTheNearestPosture) {
  const kinematics::Chain chain = manutec_r3();
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  const Pose X_border = kinematics::forward(chain, with(kUsual, 2, 0));
  const Vector outward = (X_border * Vector(0, 0, -0.25)).normalized();
  for (const double beyond : {1e-12, 1e-9, 1e-6, 1e-5}) {
    const Pose X_BG = Eigen::Translation3d(beyond * outward) * X_border;
    const Found found = solve(*sut, X_BG);
    ASSERT_FALSE(found.empty()) << beyond;
    for (const JointValues& q : found) EXPECT_LE(error_of(chain, q, X_BG), 1.1 * beyond + 1e-12) << beyond;
  }
  for (const double beyond : {1e-4, 0.01, 1.0, 1e6, 1e300}) {
    EXPECT_TRUE(solve(*sut, Eigen::Translation3d(beyond * outward) * X_border).empty()) << beyond;
  }
}

TEST(ClosedFormBorder, TargetsThatAreNoPosesGiveNothingOrSomethingFinite) {
  Random random(12);
  for (const kinematics::Chain& chain :
       {puma_560(), ur_5(), chain_of_axes(wrist_arm(Shoulder::general, random), random)}) {
    const auto sut = ClosedForm::analyse(chain);
    ASSERT_TRUE(sut);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
          Pose X_BG = kinematics::forward(chain, kUsual);
          X_BG.matrix()(row, column) = bad;
          EXPECT_TRUE(solve(*sut, X_BG).empty());
        }
      }
    }
    Pose X_zero = Pose::Identity();
    X_zero.linear().setZero();
    for (const JointValues& q : solve(*sut, X_zero)) {
      for (const double value : q) EXPECT_TRUE(std::isfinite(value));
    }
  }
}

// Each joint of the arm's frames is moved and turned by at most the given amounts, as a calibration finds.
kinematics::Chain calibrated(const kinematics::Chain& chain, double metres, double radians, Random& random) {
  std::vector<Pose> X_PJ;
  for (const kinematics::ChainJoint& joint : chain.joints()) {
    const Vector turn = random.vector(radians);
    X_PJ.push_back(Eigen::Translation3d(random.vector(metres)) * joint.X_PJ *
                   Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  }
  return chain_of_frames(X_PJ, chain.X_LT());
}

TEST(ClosedFormNearlySo, PosturesOfACalibratedArmNeedAFewStepsOfPolishing) {
  Random random(13);
  for (const kinematics::Chain& ideal : {puma_560(), manutec_r3(), ur_5()}) {
    const kinematics::Chain chain = calibrated(ideal, 5e-4, 1e-3, random);
    const auto sut = ClosedForm::analyse(chain);
    ASSERT_TRUE(sut);
    EXPECT_FALSE(sut->exact());
    EXPECT_GT(sut->deviation(), 0);
    EXPECT_LT(sut->deviation(), 0.01);
    int found_again = 0;
    constexpr int kSingularTargets = 500;
    for (int i = 0; i < kSingularTargets; ++i) {
      JointValues q = random_posture(chain, random);
      while (dexterity(chain, q) < 0.05) q = random_posture(chain, random);
      const Pose X_BG = kinematics::forward(chain, q);
      for (JointValues p : solve(*sut, X_BG, q)) {
        kinematics::FastOptions options;
        options.tolerance = 1e-9;
        options.max_iterations = 6;
        const auto polished = kinematics::fast_solve(chain, kinematics::Task{}, X_BG, std::span(p).first(6), options);
        if (polished.solved && distance(p, q) < 1e-5) {
          ++found_again;
          break;
        }
      }
    }
    EXPECT_GE(found_again, kSingularTargets * 99 / 100);
  }
}

TEST(ClosedFormNearlySo, RoundedAnglesInAFileAreNearlySo) {
  // 1.5708 for a quarter turn.
  std::vector<DhRow> rows{{0, 1.5708, 0.4, 0},  {0.45, 0, 0, 0},    {0.035, -1.5708, 0, 0},
                          {0, 1.5708, 0.42, 0}, {0, -1.5708, 0, 0}, {0, 0, 0.08, 0}};
  const kinematics::Chain chain = chain_of_dh(rows);
  const auto sut = ClosedForm::analyse(chain);
  ASSERT_TRUE(sut);
  expect_all_found(*sut, chain, 500, 14);
}

TEST(ClosedFormNearlySo, AnArmWithAnOffsetByDesignIsDeclined) {
  // A wrist whose last axis passes the other two at 60 mm.
  Random random(15);
  std::vector<Axis> axes = wrist_arm(Shoulder::parallel_23, random);
  axes[5].o += 0.06 * axes[5].h.cross(axes[4].h).normalized();
  EXPECT_FALSE(ClosedForm::analyse(chain_of_axes(axes, random)));
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
