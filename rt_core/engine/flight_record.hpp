// The flight recorder: what the loop did in its last seconds, kept in memory and written to a file on request and on a
// fault. Two histories: one record a tick, one record a sample or set point.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::engine {

struct FlightTick {
  std::uint64_t tick = 0;
  Timestamp time;
  std::uint32_t wakeup_latency_ns = 0;
  std::uint32_t compute_ns = 0;      // of the tick before, since this one is not over yet
  std::uint32_t missed_periods = 0;  // just before this tick
  std::uint16_t commands = 0;        // carried out in this tick
  std::uint16_t samples = 0;         // taken in this tick
};

enum class FlightEvent : std::uint8_t { sample, setpoint, refused_command };

struct FlightRobot {
  std::uint64_t tick = 0;
  Timestamp time;  // receive time of the sample, or time of the tick
  std::uint64_t sequence = 0;
  FlightEvent event = FlightEvent::sample;
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;
  std::array<float, kMaxJointsPerRobot> position{};  // rad or m
};

// About eight seconds at 1 kHz, and four seconds of 16,000 samples a second.
inline constexpr std::size_t kFlightTicks = 8192;
inline constexpr std::size_t kFlightRobots = 65536;

}  // namespace cellmirror::engine
