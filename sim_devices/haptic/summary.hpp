// What a run of sim_haptic was like.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_devices/haptic/latency.hpp"

namespace cellmirror::sim {

struct StruckFault {
  std::string fault;         // as it was given
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC just before the first sample that it struck was written
  std::uint64_t sequence = 0;
};

struct HapticSummary {
  bool watching = false;
  std::size_t axes = 0;
  double rate_hz = 0;
  double duration_s = 0;
  double waited_s = 0;  // for the first memory
  std::uint64_t attachments = 0;
  std::uint64_t samples = 0;
  std::uint64_t missed_periods = 0;
  double latest_start_us = 0;
  std::uint64_t forces = 0;          // answers that were read, each once
  std::uint64_t skipped_forces = 0;  // answers that were overwritten before they were read, by their numbers
  std::uint64_t torn_reads = 0;
  std::uint64_t silences = 0;         // times that the gateway fell silent: no force is felt then
  std::uint64_t skipped_samples = 0;  // that no answer was computed from
  DurationHistogram latency;          // from writing a sample to seeing the first answer to it
  DurationHistogram tick_latency;     // from its time to that of the tick that answered it
  double max_force_n = 0;
  double max_torque_nm = 0;
  double work_j = 0;      // that the gateway's forces gave to the hand
  double max_work_j = 0;  // the largest since the start: energy that was generated
  std::uint32_t last_phase = 0;
  std::uint32_t last_fault = 0;
  std::uint64_t gateway_faults = 0;  // times that a fault came up in the answers
  bool motion_done = false;
  std::vector<StruckFault> faults;
};

[[nodiscard]] std::string to_json(const HapticSummary& summary);  // one line

}  // namespace cellmirror::sim
