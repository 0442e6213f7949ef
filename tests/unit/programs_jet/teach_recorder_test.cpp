#include "scripts/programs/jet/teach_recorder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>

#include "rt_core/base/units.hpp"
#include "scripts/programs/jet/teach_parser.hpp"

namespace cellmirror::program {
namespace {

constexpr std::array kJoints{JointKind::revolute, JointKind::prismatic};
constexpr Nanoseconds kPeriod{4'000'000};

// A robot whose first joint turns at most 2 rad/s, and whose second one slides at most 0.5 m/s.
class TeachRecorderTest : public testing::Test {
 protected:
  TeachRecorder begin(TeachDialect dialect = TeachDialect::boom) {
    JointValues max_velocity{};
    max_velocity[0] = 2.0;
    max_velocity[1] = 0.5;
    return TeachRecorder::begin(dialect, "taught", kJoints, max_velocity).value();
  }
  void sample(TeachRecorder& sut) {
    time_ = time_ + kPeriod;
    sut.sample(time_, joints_);
  }
  void rest(TeachRecorder& sut, double seconds) {
    for (double passed = 0; passed < seconds; passed += 0.004) sample(sut);
  }
  // At a steady velocity.
  void go(TeachRecorder& sut, std::size_t joint, double way, double seconds) {
    const auto steps = static_cast<int>(seconds / 0.004);
    for (int i = 0; i < steps; ++i) {
      joints_[joint] += way / steps;
      sample(sut);
    }
  }

  Timestamp time_{1'000'000'000};
  JointValues joints_{};
};

TEST_F(TeachRecorderTest, MarksWhereTheRobotRests) {
  TeachRecorder sut = begin();
  rest(sut, 0.5);
  EXPECT_EQ(sut.points(), 1U);  // the beginning
  go(sut, 0, rad_from_deg(90), 2.0);
  EXPECT_EQ(sut.points(), 1U);
  rest(sut, 1.0);
  EXPECT_EQ(sut.points(), 2U);
  rest(sut, 5.0);
  EXPECT_EQ(sut.points(), 2U);  // the same rest
  go(sut, 1, 0.2, 1.0);
  rest(sut, 1.0);
  EXPECT_EQ(sut.points(), 3U);
  const std::string text = sut.finish().value();
  EXPECT_NE(text.find("\nPOINT P1 0 0\n"), std::string::npos) << text;
  // 90 degrees in 2 s are 0.785 rad/s of 2; 0.2 m/s are 40 % of 0.5.
  EXPECT_NE(text.find("\nPOINT P2 90 0 SPEED 39.3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nPOINT P3 90 200 SPEED 40"), std::string::npos) << text;
}

TEST_F(TeachRecorderTest, EndsWhereTheRobotIs) {
  TeachRecorder sut = begin(TeachDialect::tarm);
  rest(sut, 0.1);
  go(sut, 1, 0.1, 1.0);
  const std::string text = sut.finish().value();
  EXPECT_NE(text.find("\nPOINT P2 J2=100 SPEED 20"), std::string::npos) << text;
  EXPECT_EQ(text.find("TOLERANCE"), std::string::npos) << "nothing follows the last one: " << text;
}

TEST_F(TeachRecorderTest, GivesPassedPointsATolerance) {
  TeachRecorder sut = begin();
  rest(sut, 0.1);
  go(sut, 0, 0.5, 1.0);
  ASSERT_TRUE(sut.point("CORNER"));
  go(sut, 1, 0.1, 1.0);
  rest(sut, 0.5);
  ASSERT_TRUE(sut.point("STANDING"));  // P2 is there by itself
  const std::string text = sut.finish().value();
  const auto line = [&](const std::string& name) {
    const std::size_t begin = text.find("POINT " + name);
    return begin == std::string::npos ? std::string() : text.substr(begin, text.find('\n', begin) - begin);
  };
  EXPECT_NE(line("CORNER").find("TOLERANCE 10 MM"), std::string::npos) << text;
  EXPECT_EQ(line("STANDING").find("TOLERANCE"), std::string::npos) << text;
  EXPECT_EQ(line("STANDING").find("SPEED"), std::string::npos) << "no way leads to it: " << text;
}

TEST_F(TeachRecorderTest, TakesNamesThatAreFree) {
  TeachRecorder sut = begin();
  EXPECT_FALSE(sut.point("P7")) << "nothing was sampled";
  rest(sut, 0.1);
  ASSERT_TRUE(sut.point("P2"));
  EXPECT_FALSE(sut.point("P2"));
  EXPECT_FALSE(sut.point("two words"));
  ASSERT_TRUE(sut.point(""));
  const std::string text = sut.finish().value();
  EXPECT_NE(text.find("\nPOINT P3 0 0\n"), std::string::npos) << text;
}

TEST_F(TeachRecorderTest, PassesOverWhatIsNoSample) {
  TeachRecorder sut = begin();
  joints_[0] = std::numeric_limits<double>::quiet_NaN();
  sample(sut);
  EXPECT_EQ(sut.points(), 0U);
  EXPECT_FALSE(sut.finish());
  joints_[0] = 0.1;
  sample(sut);
  EXPECT_EQ(sut.points(), 1U);
  joints_[0] = 3;
  sut.sample(time_, joints_);  // the same instant once more
  EXPECT_EQ(sut.finish().value().find("P2"), std::string::npos);
}

TEST_F(TeachRecorderTest, IsReadAgain) {
  TeachRecorder sut = begin();
  rest(sut, 0.4);
  go(sut, 0, -1.0, 1.5);
  ASSERT_TRUE(sut.point("A"));
  go(sut, 1, 0.3, 1.0);
  rest(sut, 0.4);
  Diagnostics findings;
  const auto program = parse_teach_file(TeachDialect::boom, sut.finish().value(), {"taught.boom", {}}, findings);
  ASSERT_TRUE(program) << findings.text();
  EXPECT_EQ(program->name, "taught");
}

}  // namespace
}  // namespace cellmirror::program
