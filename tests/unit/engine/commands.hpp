// Commands as tests give them, and the cycles of the loop that take them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "rt_core/engine/engine.hpp"

namespace cellmirror::engine {

inline std::uint8_t slot_number(std::size_t slot) { return static_cast<std::uint8_t>(slot); }

// Of joints that all have the same range.
inline RobotSetup robot_of(std::uint8_t joints, double lower, double upper, const JointValues& positions = {}) {
  RobotSetup robot{.joint_count = joints, .positions = positions};
  robot.limits.lower.fill(lower);
  robot.limits.upper.fill(upper);
  return robot;
}

inline constexpr Nanoseconds kPeriod{1'000'000};

// The next cycle of the loop, at `now`; `missed` periods were passed over before it.
inline void run_cycle(Engine& engine, Timestamp now, std::uint64_t& cycle, std::uint64_t missed = 0,
                      Nanoseconds period = kPeriod) {
  CycleContext context;
  context.now = context.scheduled = now;
  context.cycle = cycle++;
  context.period = period;
  context.missed = missed;
  engine.run(context);
}

// So many cycles, a period apart, from a period after `now` on, which becomes the time of the last one.
inline void run_cycles(Engine& engine, Timestamp& now, std::uint64_t& cycle, int times, Nanoseconds period = kPeriod) {
  for (int i = 0; i < times; ++i) {
    now = now + period;
    run_cycle(engine, now, cycle, 0, period);
  }
}

// Of three joints that move along a curve.
inline JointSample sample_of_curve(Timestamp receive_time, std::uint64_t sequence) {
  JointSample sample;
  sample.receive_time = receive_time;
  sample.sequence = sequence;
  sample.present = 7;
  for (std::size_t j = 0; j < 3; ++j) sample.position[j] = std::sin(0.01 * static_cast<double>(sequence + j));
  return sample;
}

inline std::uint64_t send_robot(Engine& engine, std::size_t slot, const RobotSetup& robot) {
  return engine.send(
      AddRobot{.slot = slot_number(slot), .robot = engine.lend(std::make_shared<const RobotSetup>(robot))});
}

inline std::uint64_t send_limits(Engine& engine, std::size_t slot, const JointLimits& limits) {
  return engine.send(
      SetLimits{.slot = slot_number(slot), .limits = engine.lend(std::make_shared<const JointLimits>(limits))});
}

inline std::uint64_t send_move(Engine& engine, std::size_t slot, const motion::Move& move) {
  return engine.send(
      AddMove{.slot = slot_number(slot), .move = engine.lend(std::make_shared<const motion::Move>(move))});
}

inline std::uint64_t send_coupling(Engine& engine, const Coupling& coupling) {
  return engine.send(Couple{engine.lend(std::make_shared<const Coupling>(coupling))});
}

}  // namespace cellmirror::engine
