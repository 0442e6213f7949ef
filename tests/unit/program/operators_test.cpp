// Every operator: its value, its type, and what it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program {
namespace {

using Integer = std::int64_t;
constexpr Integer kLargest = std::numeric_limits<Integer>::max();
constexpr Integer kLeast = std::numeric_limits<Integer>::min();
constexpr double kHuge = std::numeric_limits<double>::max();

Integer n(Integer value) { return value; }

struct Expected {
  Operator which;
  std::vector<Value> operands;
  Value value;
};

std::string text_of(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<Integer>(&value)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&value)) return std::to_string(*real) + " (real)";
  return std::string(name_of(type_of(value)));
}

bool same(const Value& a, const Value& b) {
  if (a.index() != b.index()) return false;
  if (const auto* real = std::get_if<double>(&a)) return std::abs(*real - std::get<double>(b)) < 1e-12;
  if (const auto* boolean = std::get_if<bool>(&a)) return *boolean == std::get<bool>(b);
  return std::get<Integer>(a) == std::get<Integer>(b);
}

TEST(Operators, GiveTheirValuesAndStayIntegersWhereTheyCan) {
  const std::vector<Expected> table = {
      {Operator::negate, {n(3)}, n(-3)},
      {Operator::negate, {2.5}, -2.5},
      {Operator::add, {n(2), n(3)}, n(5)},
      {Operator::add, {n(2), 0.5}, 2.5},
      {Operator::subtract, {n(2), n(3)}, n(-1)},
      {Operator::subtract, {2.0, n(3)}, -1.0},
      {Operator::multiply, {n(-4), n(3)}, n(-12)},
      {Operator::multiply, {0.5, n(3)}, 1.5},
      {Operator::divide, {n(7), n(2)}, 3.5},
      {Operator::divide, {n(6), n(2)}, 3.0},
      {Operator::integer_divide, {n(7), n(2)}, n(3)},
      {Operator::integer_divide, {n(-7), n(2)}, n(-3)},
      {Operator::integer_divide, {n(7), n(-1)}, n(-7)},
      {Operator::modulo, {n(7), n(3)}, n(1)},
      {Operator::modulo, {n(-7), n(3)}, n(-1)},
      {Operator::modulo, {kLeast, n(-1)}, n(0)},
      {Operator::power, {n(2), n(10)}, 1024.0},
      {Operator::power, {2.0, -1.0}, 0.5},
      {Operator::absolute, {n(-4)}, n(4)},
      {Operator::absolute, {-4.5}, 4.5},
      {Operator::square_root, {n(9)}, 3.0},
      {Operator::sine, {std::numbers::pi / 6}, 0.5},
      {Operator::cosine, {std::numbers::pi / 3}, 0.5},
      {Operator::tangent, {std::numbers::pi / 4}, 1.0},
      {Operator::arc_sine, {n(1)}, std::numbers::pi / 2},
      {Operator::arc_cosine, {n(0)}, std::numbers::pi / 2},
      {Operator::arc_tangent, {1.0, -1.0}, 3 * std::numbers::pi / 4},
      {Operator::minimum, {n(2), n(3)}, n(2)},
      {Operator::minimum, {n(2), 1.5}, 1.5},
      {Operator::maximum, {n(2), n(3)}, n(3)},
      {Operator::maximum, {n(2), 1.5}, 2.0},
      {Operator::round, {2.5}, n(3)},
      {Operator::round, {-2.5}, n(-3)},
      {Operator::round, {n(4)}, n(4)},
      {Operator::truncate, {2.9}, n(2)},
      {Operator::truncate, {-2.9}, n(-2)},
      {Operator::to_real, {n(4)}, 4.0},
      {Operator::equal, {n(1), 1.0}, true},
      {Operator::equal, {true, false}, false},
      {Operator::not_equal, {n(1), n(2)}, true},
      {Operator::not_equal, {true, true}, false},
      {Operator::less, {n(1), n(2)}, true},
      {Operator::less, {2.0, n(2)}, false},
      {Operator::less_equal, {n(2), n(2)}, true},
      {Operator::greater, {2.5, n(2)}, true},
      {Operator::greater_equal, {n(1), n(2)}, false},
      {Operator::logical_and, {true, false}, false},
      {Operator::logical_and, {n(6), n(3)}, n(2)},
      {Operator::logical_or, {true, false}, true},
      {Operator::logical_or, {n(6), n(3)}, n(7)},
      {Operator::logical_xor, {true, true}, false},
      {Operator::logical_xor, {n(6), n(3)}, n(5)},
      {Operator::logical_not, {false}, true},
      {Operator::logical_not, {n(0)}, n(-1)},
  };
  for (const Expected& expected : table) {
    std::vector<ValueType> types;
    for (const Value& operand : expected.operands) types.push_back(type_of(operand));
    const auto value = apply(expected.which, expected.operands, 0);
    ASSERT_TRUE(value) << name_of(expected.which) << ": " << value.error().text();
    EXPECT_TRUE(same(*value, expected.value))
        << name_of(expected.which) << " gives " << text_of(*value) << ", not " << text_of(expected.value);
    const auto type = result_type(expected.which, types);
    ASSERT_TRUE(type) << name_of(expected.which);
    EXPECT_EQ(*type, type_of(expected.value)) << name_of(expected.which);
  }
}

TEST(Operators, RefuseWhatHasNoResult) {
  const std::vector<Expected> table = {
      {Operator::negate, {kLeast}, false},
      {Operator::absolute, {kLeast}, false},
      {Operator::add, {kLargest, n(1)}, false},
      {Operator::subtract, {kLeast, n(1)}, false},
      {Operator::multiply, {kLargest, n(2)}, false},
      {Operator::integer_divide, {n(1), n(0)}, false},
      {Operator::integer_divide, {kLeast, n(-1)}, false},
      {Operator::modulo, {n(1), n(0)}, false},
      {Operator::divide, {1.0, n(0)}, false},
      {Operator::add, {kHuge, kHuge}, false},
      {Operator::multiply, {kHuge, 10.0}, false},
      {Operator::power, {-8.0, 0.5}, false},
      {Operator::power, {10.0, 400.0}, false},
      {Operator::square_root, {-1.0}, false},
      {Operator::arc_sine, {1.5}, false},
      {Operator::arc_cosine, {n(-2)}, false},
      {Operator::round, {1e30}, false},
      {Operator::truncate, {-1e30}, false},
  };
  for (const Expected& expected : table) {
    EXPECT_FALSE(apply(expected.which, expected.operands, 0)) << name_of(expected.which);
  }
}

TEST(Operators, RefuseTypesThatTheyDoNotTake) {
  const std::vector<std::pair<Operator, std::vector<ValueType>>> table = {
      {Operator::add, {ValueType::integer, ValueType::boolean}},
      {Operator::add, {ValueType::pose, ValueType::pose}},
      {Operator::integer_divide, {ValueType::real, ValueType::integer}},
      {Operator::modulo, {ValueType::integer, ValueType::real}},
      {Operator::sine, {ValueType::pose}},
      {Operator::less, {ValueType::boolean, ValueType::boolean}},
      {Operator::equal, {ValueType::pose, ValueType::pose}},
      {Operator::equal, {ValueType::integer, ValueType::boolean}},
      {Operator::logical_and, {ValueType::boolean, ValueType::integer}},
      {Operator::logical_not, {ValueType::real}},
      {Operator::compose, {ValueType::pose, ValueType::real}},
      {Operator::inverse, {ValueType::joints}},
      {Operator::component, {ValueType::real}},
      {Operator::digital_input, {ValueType::real}},
      {Operator::make_joints, {ValueType::boolean}},
      {Operator::add, {ValueType::integer}},
      {Operator::make_pose, {ValueType::real}},
      {Operator::current_joints, {ValueType::real}},
  };
  for (const auto& [which, types] : table) EXPECT_FALSE(result_type(which, types)) << name_of(which);
}

TEST(Operators, PutPosesTogetherAndTakeThemApart) {
  const double quarter = std::numbers::pi / 2;
  const auto X_AB = apply(Operator::make_pose, std::vector<Value>{1.0, n(2), 3.0, 0.0, 0.0, quarter}, 0);
  const auto X_BC = apply(Operator::make_pose, std::vector<Value>{1.0, 0.0, 0.0, quarter, 0.0, 0.0}, 0);
  ASSERT_TRUE(X_AB && X_BC);
  const auto X_AC = apply(Operator::compose, std::vector<Value>{*X_AB, *X_BC}, 0);
  ASSERT_TRUE(X_AC);
  const double expected[] = {1.0, 3.0, 3.0, quarter, 0.0, quarter};
  for (std::uint32_t index = 0; index < 6; ++index) {
    const auto component = apply(Operator::component, std::vector<Value>{*X_AC}, index);
    ASSERT_TRUE(component);
    EXPECT_NEAR(std::get<double>(*component), expected[index], 1e-12) << index;
  }
  const auto X_BA = apply(Operator::inverse, std::vector<Value>{*X_AB}, 0);
  ASSERT_TRUE(X_BA);
  const Pose around = std::get<Pose>(*X_AB) * std::get<Pose>(*X_BA);
  EXPECT_TRUE(around.isApprox(Pose::Identity(), 1e-12));
}

TEST(Operators, MakeJointValuesInTheirUnits) {
  const auto joints =
      apply(Operator::make_joints, std::vector<Value>{n(90), 250.0}, static_cast<std::uint32_t>(JointUnits::degree_mm));
  ASSERT_TRUE(joints);
  const JointKind kinds[] = {JointKind::revolute, JointKind::prismatic};
  const auto si = joint_values_si(std::get<JointPosition>(*joints), kinds);
  ASSERT_TRUE(si);
  EXPECT_DOUBLE_EQ((*si)[0], std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ((*si)[1], 0.25);
  EXPECT_FALSE(joint_values_si(std::get<JointPosition>(*joints), std::span(kinds).first(1)));
  EXPECT_EQ(std::get<double>(*apply(Operator::component, std::vector<Value>{*joints}, 1)), 250.0);
  EXPECT_FALSE(apply(Operator::component, std::vector<Value>{*joints}, 2));
  const JointPosition back = joint_position(*si, kinds, JointUnits::degree_mm);
  EXPECT_DOUBLE_EQ(back.values[0], 90);
  EXPECT_DOUBLE_EQ(back.values[1], 250);
}

}  // namespace
}  // namespace cellmirror::program
