// A pair is left out only where that is proved for all positions of the joints.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "rt_core/collision/body_proximity.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pair_proof.hpp"
#include "rt_core/collision/sampling.hpp"
#include "tests/unit/collision/cell_of_bodies.hpp"

namespace cellmirror::collision {
namespace {

// The kinematics of a UR5e, with a ball of 20 mm on the base and one 100 mm beyond the flange: they meet in a region of
// postures so small that thousands of random ones miss it.
constexpr const char* kTwoBalls = R"(
[[node]]
name = "PEG"
xyz_m = [-0.2960256344757486, 0.003701282958497378, 0.09273473170669592]
geometry = [{ name = "peg", sphere_m = 0.02 }]
[[node]]
name = "J_1"
xyz_m = [0.0, 0.0, 0.1625]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-6.283185307179586, 6.283185307179586], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_2"
parent = "J_1"
rpy_rad = [1.570796327, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-6.283185307179586, 6.283185307179586], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_3"
parent = "J_2"
xyz_m = [-0.425, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-3.141592653589793, 3.141592653589793], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_4"
parent = "J_3"
xyz_m = [-0.3922, 0.0, 0.1333]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-6.283185307179586, 6.283185307179586], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_5"
parent = "J_4"
xyz_m = [0.0, -0.0997, 0.0]
rpy_rad = [1.570796327, 0.0, 0.0]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-6.283185307179586, 6.283185307179586], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "J_6"
parent = "J_5"
xyz_m = [0.0, 0.0996, 0.0]
rpy_rad = [1.570796326589793, 3.141592653589793, 3.141592653589793]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-6.283185307179586, 6.283185307179586], velocity_rad_s = 3.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "TIP"
parent = "J_6"
xyz_m = [0.0, 0.0, 0.1]
geometry = [{ name = "tip", sphere_m = 0.02 }]
[robot]
id = "UR"
flange = "TIP"
)";

// A ball on an arm of 1 m that turns about z. `joint`: the type and range of its joint.
std::string turning_ball(const std::string& joint) {
  return R"(
geometry = [{ name = "post", sphere_m = 0.1 }]
[[node]]
name = "A"
xyz_m = [0.0, 0.0, 1.0]
joint = { axis = [0, 0, 1], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0, )" +
         joint + R"( }
[[node]]
name = "B"
parent = "A"
xyz_m = [1.0, 0.0, 0.0]
geometry = [{ name = "ball", sphere_m = 0.1 }]
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-1.0, 1.0], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[robot]
id = "R"
flange = "B"
)";
}

std::string sledge_from(const std::string& range) {
  return R"(
[[node]]
name = "X"
geometry = [{ name = "ball", sphere_m = 0.1 }]
joint = { type = "prismatic", axis = [1, 0, 0], range_m = )" +
         range + R"(, velocity_m_s = 1.5, acceleration_m_s2 = 3.0 }
[robot]
id = "LONG"
flange = "X"
)";
}

struct PairProofTest : CellOfBodies {
  void build_one(const std::string& component) {
    files->add("one.mpc", component);
    build("[[node]]\nname = \"R\"\nabstract = \"one.mpc\"\n");
  }
  RelativeMotion motion_of(const std::string& a, const std::string& b) const {
    return Mechanism(*compiled).between(body(a).node, body(b).node);
  }
  const Body& body(const std::string& name) const {
    for (std::size_t i = 0; i < table->bodies.size(); ++i) {
      if ((*table->names)[i] == name) return table->bodies[i];
    }
    throw std::runtime_error("no body " + name);
  }
};

TEST_F(PairProofTest, TestsAPairWhoseContactsSamplingMisses) {
  build_one(kTwoBalls);
  const std::string tip = "R.J_1.J_2.J_3.J_4.J_5.J_6.TIP";
  const std::string peg = "R.PEG";
  EXPECT_EQ(state(peg, tip), PairState::tested);
  adopt();
  const std::array<double, 6> posture{-0.590276502391801, -0.423711489772515, 1.92776377541018,
                                      -0.311272956700102, -1.42807738759895,  0.0};
  for (std::size_t i = 0; i < posture.size(); ++i) joint("UR", i) = posture[i];
  ASSERT_EQ(check().touching.size(), 1U);
  EXPECT_GT(check().touching[0].depth_m, 0.03);
}

TEST_F(PairProofTest, BoundsEveryMotionWithinABox) {
  build_one(kTwoBalls);
  const RelativeMotion motion = motion_of("R.PEG", "R.J_1.J_2.J_3.J_4.J_5.J_6.TIP");
  const Body& a = body("R.PEG");
  const Body& b = body("R.J_1.J_2.J_3.J_4.J_5.J_6.TIP");
  MotionBound bounds(motion, a, b);
  std::mt19937_64 dice(7);  // NOLINT: the same numbers in every run
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double tightest = 0;
  for (int round = 0; round < 300; ++round) {
    MotionBound::JointBox box = bounds.whole_range();
    const double width = std::pow(10.0, -2.0 + 2.0 * std::abs(unit(dice)));
    for (std::size_t i = 0; i < box.centre.size(); ++i) {
      box.centre[i] += unit(dice) * box.half[i] * (1.0 - width);
      box.half[i] *= width;
    }
    const double bound = bounds.compute(box);
    const double at_centre = bounds.X_AB().translation().norm();
    for (int i = 0; i < 50; ++i) {
      std::vector<double> at = box.centre;
      for (std::size_t k = 0; k < at.size(); ++k)
        at[k] += (i % 2 == 0 ? unit(dice) : std::copysign(1.0, unit(dice))) * box.half[k];
      const double change = std::abs(motion.X_AB(at).translation().norm() - at_centre);
      EXPECT_LE(change, bound + 1e-9);
      tightest = std::max(tightest, change / bound);
    }
  }
  EXPECT_GT(tightest, 0.1) << "a bound that is never approached would prove nothing";
}

TEST_F(PairProofTest, ProvesWhatStaysApartInEveryPosture) {
  build_one(turning_ball("type = \"revolute\", range_rad = [-3.0, 3.0]"));
  const ProofResult apart = prove_apart(motion_of("R", "R.A.B"), body("R"), body("R.A.B"), 0.005);
  EXPECT_EQ(apart.proof, Proof::proved);
  EXPECT_LT(apart.tests, kMostApartTests);
  // The balls are sqrt(2) - 0.2 apart in every posture, so that this margin is met by none.
  EXPECT_EQ(prove_apart(motion_of("R", "R.A.B"), body("R"), body("R.A.B"), 1.22).proof, Proof::refuted);
  EXPECT_EQ(prove_touching(motion_of("R", "R.A.B"), body("R"), body("R.A.B")).proof, Proof::refuted);
}

TEST_F(PairProofTest, ProvesATurnOfAJointWithoutEnd) {
  build_one(turning_ball("type = \"continuous\""));
  EXPECT_EQ(state("R", "R.A.B"), PairState::never);
}

TEST_F(PairProofTest, ProvesNothingAboutAJointThatFollowsOneWithoutEndInPart) {
  // B repeats its postures after four turns of A only.
  files->add("one.mpc", R"(
geometry = [{ name = "post", sphere_m = 0.1 }]
[[node]]
name = "A"
xyz_m = [0.0, 0.0, 1.0]
joint = { type = "continuous", axis = [0, 0, 1], velocity_rad_s = 2.0, acceleration_rad_s2 = 4.0 }
[[node]]
name = "B"
parent = "A"
xyz_m = [1.0, 0.0, 0.0]
geometry = [{ name = "ball", sphere_m = 0.1 }]
joint = { type = "revolute", axis = [0, 0, 1], mimic = { joint = "A", multiplier = 0.25 } }
[robot]
id = "R"
flange = "B"
)");
  build("[[node]]\nname = \"R\"\nabstract = \"one.mpc\"\n");
  EXPECT_EQ(state("R", "R.A.B"), PairState::tested);
  EXPECT_NE(pair("R", "R.A.B")->reason.find("which is not proved"), std::string::npos);
}

TEST_F(PairProofTest, TakesTheWholeRangeOfALongLinearAxis) {
  // The block reaches from 99 to 101 m; the axis begins at 100 and ends at 200 m.
  files->add("long.mpc", sledge_from("[100.0, 200.0]"));
  build(R"(
[[node]]
name = "Block"
xyz_m = [100.0, 0.0, 0.0]
geometry = [{ name = "block", box_m = [2.0, 2.0, 2.0] }]
[[node]]
name = "Long"
abstract = "long.mpc"
)");
  EXPECT_EQ(state("Block", "Long.X"), PairState::tested);
}

TEST_F(PairProofTest, LeavesOutAsTouchingOnlyWhatIsProved) {
  // The ball stays within Block along its whole way; it leaves Far by 0.2 mm at the end of its range.
  files->add("inside.mpc", sledge_from("[-0.5, 0.5]"));
  build(R"(
[[node]]
name = "Block"
geometry = [{ name = "block", box_m = [1.3, 1.0, 1.0] }]
[[node]]
name = "Far"
xyz_m = [-0.7002, 0.0, 0.0]
geometry = [{ name = "far", box_m = [2.2, 0.2, 0.2] }]
[[node]]
name = "Long"
abstract = "inside.mpc"
)");
  EXPECT_EQ(state("Block", "Long.X"), PairState::always);
  EXPECT_EQ(state("Far", "Long.X"), PairState::tested);
}

TEST_F(PairProofTest, ProvesNothingAboutARobotBeyondItsRanges) {
  build("[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n");
  ASSERT_EQ(state("Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4"), PairState::never);
  RangeWatch watch;
  EXPECT_FALSE(watch.note(*compiled, q));
  joint("ARM", 2) = 2.005;  // within the tolerance
  EXPECT_FALSE(watch.note(*compiled, q));
  joint("ARM", 2) = 2.2;
  EXPECT_TRUE(watch.note(*compiled, q));
  EXPECT_FALSE(watch.note(*compiled, q)) << "known already";
  table = derivation.derive(*compiled, settings, watch.beyond());
  EXPECT_EQ(state("Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4"), PairState::tested);
  watch.clear();
  table = derivation.derive(*compiled, settings, watch.beyond());
  EXPECT_EQ(state("Arm.J_1.J_2", "Arm.J_1.J_2.J_3.J_4"), PairState::never);
}

// Searches for the smallest distance from many start postures: each pair that is left out must keep the margin.
TEST_F(PairProofTest, FindsNoPostureAgainstAProof) {
  std::mt19937_64 dice(11);  // NOLINT: the same numbers in every run
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int proved = 0;
  for (int robot = 0; robot < 12; ++robot) {
    std::string text = "geometry = [{ name = \"g\", sphere_m = 0.1 }]\n";
    std::string parent;
    for (int i = 0; i < 4; ++i) {
      const std::string name = "J_" + std::to_string(i);
      text += fmt::format(
          "[[node]]\nname = \"{}\"\n{}xyz_m = [{:.3f}, {:.3f}, {:.3f}]\nrpy_rad = [{:.3f}, {:.3f}, 0.0]\n"
          "geometry = [{{ name = \"g\", capsule_m = [0.04, 0.2] }}]\njoint = {{ type = \"revolute\", axis = [0, 0, 1], "
          "range_rad = [{:.3f}, {:.3f}], velocity_rad_s = 1.0, acceleration_rad_s2 = 1.0 }}\n",
          name, parent.empty() ? "" : "parent = \"" + parent + "\"\n", 0.3 * unit(dice), 0.3 * unit(dice),
          0.4 + 0.1 * unit(dice), unit(dice), unit(dice), -1.0 + 0.9 * unit(dice), 1.0 + 0.9 * unit(dice));
      parent = name;
    }
    build_one(text + "[robot]\nid = \"R\"\nflange = \"J_3\"\n");
    for (const Pair& candidate : table->pairs) {
      if (candidate.state != PairState::never) continue;
      ++proved;
      const Body& a = table->bodies[candidate.a];
      const Body& b = table->bodies[candidate.b];
      const RelativeMotion motion = Mechanism(*compiled).between(a.node, b.node);
      BodyProximity proximity(a, b);
      for (int start = 0; start < 20; ++start) {
        std::vector<double> at;
        for (const SampledRange& range : motion.variables)
          at.push_back(range.lower + (0.5 + 0.5 * unit(dice)) * (range.upper - range.lower));
        double least = proximity.distance(motion.X_AB(at), 1e9);
        for (double step = 0.5; step > 1e-3; step *= 0.97) {
          std::vector<double> next = at;
          for (std::size_t i = 0; i < next.size(); ++i)
            next[i] = std::clamp(next[i] + step * unit(dice), motion.variables[i].lower, motion.variables[i].upper);
          const double distance = proximity.distance(motion.X_AB(next), 1e9);
          if (distance >= least) continue;
          least = distance;
          at = next;
        }
        ASSERT_GE(least, kNeverMargin) << robot << ' ' << candidate.a << ' ' << candidate.b;
      }
    }
  }
  EXPECT_GT(proved, 5);
}

}  // namespace
}  // namespace cellmirror::collision
