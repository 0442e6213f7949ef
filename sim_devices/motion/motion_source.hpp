// How the simulated robots move. Pure functions of time, in SI.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "sim_devices/faults/message.hpp"

namespace cellmirror::sim {

class MotionSource {
 public:
  virtual ~MotionSource() = default;
  // The values of all joints of one robot `t_s` seconds after the start; values.size() joints. Effort is left alone.
  virtual void at(double t_s, std::span<JointValue> values) const = 0;
};

// From its text form:
//   hold[:position=Q]                                     stands still
//   ramp[:velocity=V,offset=Q]                            position = Q + V t, so that a value identifies its time
//   sine[:amplitude=A,period=T,offset=Q,phase=P,step=S]   Q + A sin(2 pi t / T + P + j S), j = 0 for joint 1
//   waypoints:FILE.csv[,once]                             stops at each row, minimum jerk between them
//   recorded:FILE.csv[,once]                              plays rows, linear between them
// FILE: one row a point, "time_s, q1, q2, ..." in s and rad or m, a heading line and lines with # are allowed; without
// `once` it repeats. `joints` is how many values each row must have at least.
[[nodiscard]] Result<std::unique_ptr<MotionSource>> make_motion(std::string_view text, std::size_t joints);
[[nodiscard]] std::string motion_help();

}  // namespace cellmirror::sim
