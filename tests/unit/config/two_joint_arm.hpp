// The component of a small robot "ARM": J_1 turns (-1 to 2 rad), J_2 slides (0 to 1 m).
#pragma once

namespace cellmirror {

inline constexpr const char* kTwoJointArm = R"(format = 1
[[node]]
name = "J_1"
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-1, 2], velocity_rad_s = 3, acceleration_rad_s2 = 20 }
[[node]]
name = "J_2"
parent = "J_1"
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0, 1], velocity_m_s = 1 }
[robot]
id = "ARM"
flange = "J_2"
)";

}  // namespace cellmirror
