#include "app/console/display_names.hpp"

#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

TEST(ShortNames, leaveOutTheMiddleWhereOnlyOneBodyCanBeMeant) {
  const std::vector<std::string> paths{"Floor", "A.J_1.J_2", "A.J_1.J_2.J_3", "B.J_1.J_2", "C.Left.Jaw", "C.Right.Jaw"};
  EXPECT_EQ(short_names(paths),
            (std::vector<std::string>{"Floor", "A.J_2", "A.J_3", "B.J_2", "C.Left.Jaw", "C.Right.Jaw"}));
}

TEST(ShortNames, areNotThoseOfAnotherBody) {
  EXPECT_EQ(short_names({"A.J_2", "A.J_1.J_2"}), (std::vector<std::string>{"A.J_2", "A.J_1.J_2"}));
}

TEST(ShortNames, canBePrinted) { EXPECT_EQ(short_names({"A\x1b[2J"}).front(), "A\\x1b[2J"); }

TEST(PointText, hasNoNegativeZero) { EXPECT_EQ(point_text({-1e-9, -0.0004, -0.0006}), "0.000 0.000 -0.001"); }

}  // namespace
}  // namespace cellmirror::app
