#include "scripts/programs/jet/teach_writer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>

#include "rt_core/base/units.hpp"
#include "scripts/programs/jet/teach_parser.hpp"

namespace cellmirror::program {
namespace {

constexpr std::array kJointCount{JointKind::revolute, JointKind::prismatic, JointKind::continuous};

CheckPoint point(std::string name, double degrees, double mm, double more_degrees) {
  CheckPoint point;
  point.name = std::move(name);
  point.joints[0] = rad_from_deg(degrees);
  point.joints[1] = m_from_mm(mm);
  point.joints[2] = rad_from_deg(more_degrees);
  return point;
}

TEST(TeachWriter, WritesAValueForEveryJointOfABoom) {
  auto sut = TeachWriter::begin(TeachDialect::boom, "task", kJointCount).value();
  sut.comment("of MANTEC_R3,\nrecorded");
  ASSERT_TRUE(sut.add(point("P1", 45, -12.5, 0)));
  CheckPoint second = point("P2", -0.0000001, 1000, 30.123456);
  second.speed = 0.425;
  second.tolerance = TeachTolerance{FlyType::distance, 0.01};
  ASSERT_TRUE(sut.add(second));
  EXPECT_EQ(sut.text(),
            "JET_BOOM 1\nNAME task\nJOINTS 3\n# of MANTEC_R3, recorded\n"
            "POINT P1 45 -12.5 0\nPOINT P2 0 1000 30.123456 SPEED 42.5 TOLERANCE 10 MM\nEND\n");
}

TEST(TeachWriter, WritesWhatMovesOfAMast) {
  auto sut = TeachWriter::begin(TeachDialect::tarm, "mast", kJointCount).value();
  ASSERT_TRUE(sut.add(point("P1", 0, 0, 0)));
  ASSERT_TRUE(sut.add(point("P2", 0, 800, 0)));
  ASSERT_TRUE(sut.add(point("P3", 0, 800, 1e-9)));
  EXPECT_EQ(sut.text(), "JET_TARM 1\nNAME mast\nJOINTS 3\nPOINT P1 J1=0 J2=0 J3=0\nPOINT P2 J2=800\nPOINT P3\nEND\n");
}

TEST(TeachWriter, WritesWhatTheReaderTakes) {
  for (const TeachDialect dialect : {TeachDialect::boom, TeachDialect::tarm}) {
    auto sut = TeachWriter::begin(dialect, "task", kJointCount).value();
    int number = 0;
    for (const FlyType type : {FlyType::speed_fraction, FlyType::distance, FlyType::angle}) {
      CheckPoint next = point("P" + std::to_string(number), 10.0 * number, 3.25 * number, -1);
      next.tolerance = TeachTolerance{type, 0.125};
      next.speed = number == 0 ? 1e-4 : 1.0;
      ASSERT_TRUE(sut.add(next));
      ++number;
    }
    Diagnostics findings;
    EXPECT_TRUE(parse_teach_file(dialect, sut.text(), {"task", {}}, findings)) << findings.text();
  }
}

TEST(TeachWriter, RefusesWhatTheReaderWouldNotTake) {
  auto sut = TeachWriter::begin(TeachDialect::boom, "task", kJointCount).value();
  ASSERT_TRUE(sut.add(point("P1", 0, 0, 0)));
  const std::string before = sut.text();
  EXPECT_FALSE(sut.add(point("P1", 1, 1, 1)));   // the name is known
  EXPECT_FALSE(sut.add(point("P 2", 1, 1, 1)));  // and this is none
  EXPECT_FALSE(sut.add(point("P2", 0, 1.1e6, 0)));
  EXPECT_FALSE(sut.add(point("P2", std::numeric_limits<double>::quiet_NaN(), 0, 0)));
  CheckPoint wrong = point("P2", 0, 0, 0);
  wrong.speed = 1.01;
  EXPECT_FALSE(sut.add(wrong));
  wrong.speed.reset();
  wrong.tolerance = TeachTolerance{FlyType::angle, -0.1};
  EXPECT_FALSE(sut.add(wrong));
  EXPECT_EQ(sut.text(), before);
  EXPECT_EQ(sut.points(), 1U);
}

TEST(TeachWriter, NeedsANameAndJoints) {
  EXPECT_FALSE(TeachWriter::begin(TeachDialect::boom, "no name", kJointCount));
  EXPECT_FALSE(TeachWriter::begin(TeachDialect::boom, "task", {}));
  EXPECT_FALSE(TeachWriter::begin(TeachDialect::boom, "task", std::vector(17, JointKind::revolute)));
}

}  // namespace
}  // namespace cellmirror::program
