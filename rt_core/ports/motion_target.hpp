// Where a motion command of SCRIPT leads: POS_ROB (manual 1.2.1) and our MOVE_ROB.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

enum class TargetMode : std::uint8_t {
  joint_abs,
  joint_inc,
  frame_abs,
  frame_inc,
  tool_inc,
  screen_inc,
  start_position,      // rob_jnt_start_pos; MOVE_ROB only
  reference_position,  // rob_jnt_ref_pos; MOVE_ROB only
};
// As SCRIPT writes it.
[[nodiscard]] constexpr std::string_view name_of(TargetMode mode) {
  constexpr std::array<std::string_view, 8> kNames = {"JOINT_ABS", "JOINT_INC",  "FRAME_ABS", "FRAME_INC",
                                                      "TOOL_INC",  "SCREEN_INC", "START",     "REFERENCE"};
  return kNames[static_cast<std::size_t>(mode)];
}

struct MotionTarget {
  TargetMode mode = TargetMode::joint_abs;
  // joint_abs, joint_inc: rad or m; of the first joints, the others stay.
  std::span<const double> joints;
  // frame_abs: X_ZT, the TCP in the robot's ZP frame. frame_inc, tool_inc, screen_inc: a translation and a rotation in
  // the axes of the ZP frame, of the TCP, or of the screen.
  Pose pose = Pose::Identity();
};

enum class MovePath : std::uint8_t { joints, linear };  // PTP, LIN

}  // namespace cellmirror
