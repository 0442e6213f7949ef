#include "sim_devices/haptic/summary.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::sim {
namespace {

template <std::size_t N>
std::string word(const std::array<std::string_view, N>& words, std::uint32_t number) {
  return number < N ? std::string(words[number]) : fmt::format("{}", number);
}

void add(JsonWriter& out, std::string_view name, const DurationHistogram& h) {
  out.key(name)
      .begin_object()
      .member("count", h.count())
      .fixed_member("p50", h.quantile_us(0.5), 1)
      .fixed_member("p99", h.quantile_us(0.99), 1)
      .fixed_member("max", h.max_us(), 1)
      .end_object();
}

}  // namespace

std::string to_json(const HapticSummary& s) {
  JsonWriter out;
  out.begin_object()
      .member("device", s.watching ? "haptic watcher" : "haptic")
      .member("axes", s.axes)
      .member("rate_hz", s.rate_hz)
      .fixed_member("duration_s", s.duration_s, 3)
      .fixed_member("waited_s", s.waited_s, 3)
      .member("attachments", s.attachments)
      .member("samples", s.samples)
      .member("missed_periods", s.missed_periods)
      .fixed_member("latest_start_us", s.latest_start_us, 1)
      .member("skipped_samples", s.skipped_samples)
      .member("forces", s.forces)
      .member("skipped_forces", s.skipped_forces)
      .member("torn_reads", s.torn_reads)
      .member("silences", s.silences);
  add(out, "latency_us", s.latency);
  add(out, "tick_latency_us", s.tick_latency);
  out.fixed_member("max_force_n", s.max_force_n, 4)
      .fixed_member("max_torque_nm", s.max_torque_nm, 4)
      .fixed_member("work_j", s.work_j, 6)
      .fixed_member("max_work_j", s.max_work_j, 6)
      .member("phase", word(kHapticPhaseWords, s.last_phase))
      .member("fault", word(kHapticFaultWords, s.last_fault))
      .member("gateway_faults", s.gateway_faults)
      .member("motion_done", s.motion_done)
      .key("faults")
      .begin_array();
  for (const StruckFault& fault : s.faults) {
    out.begin_object()
        .member("fault", fault.fault)
        .member("time_ns", fault.time_ns)
        .member("sequence", fault.sequence)
        .end_object();
  }
  return out.end_array().end_object().take();
}

}  // namespace cellmirror::sim
