// Arms whose axes lie along x, y and z through the points of a coarse grid: every way in which axes can coincide, be
// parallel or meet, together with every degenerate one.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "closed_form_checks.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using namespace test;

std::vector<Axis> grid_arm(Random& random) {
  const auto below = [&random](int count) { return static_cast<int>(random.between(0, count)); };
  std::vector<Axis> axes(6);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].h = (below(2) == 0 ? -1 : 1) * Vector::Unit(below(3));
    axes[i].o = i > 0 && below(2) == 0 ? axes[i - 1].o : Vector(0.1 * Vector(below(4), below(4), below(4)));
  }
  return axes;
}

TEST(ClosedFormGridArms, WhatIsAcceptedIsSolvedAndCanMoveFreely) {
  std::set<std::string> families;
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    Random random(seed);
    const kinematics::Chain chain = chain_of_axes(grid_arm(random), random);
    const auto sut = ClosedForm::analyse(chain);
    if (!sut) continue;
    SCOPED_TRACE(seed);
    families.insert(std::string(sut->family()) + (sut->from_tip() ? ", from the tip" : ""));
    EXPECT_TRUE(sut->exact());
    int free = 0;
    for (int i = 0; i < 20; ++i) free += dexterity(chain, random_posture(chain, random)) > 1e-4;
    ASSERT_GT(free, 10);
    expect_all_found(*sut, chain, 50, seed);
  }
  EXPECT_EQ(families.size(), 14U);  // each of seven, both ways round
}

}  // namespace
}  // namespace cellmirror::inverse_kinematics
