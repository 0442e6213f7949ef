#include "sim_devices/haptic/summary.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace cellmirror::sim {
namespace {

constexpr std::array<std::string_view, 6> kPhases{"closed", "waiting", "clutched", "engaging", "active", "faulted"};
constexpr std::array<std::string_view, 11> kFaults{"none",      "stale",       "vanished",    "not_finite",
                                                   "invalid",   "jump",        "two_writers", "torn",
                                                   "late_tick", "stale_model", "not_passive"};

template <std::size_t N>
std::string word(const std::array<std::string_view, N>& words, std::uint32_t number) {
  return number < N ? std::string(words[number]) : fmt::format("{}", number);
}

std::string to_json(const DurationHistogram& h) {
  return fmt::format(R"({{"count":{},"p50":{:.1f},"p99":{:.1f},"max":{:.1f}}})", h.count(), h.quantile_us(0.5),
                     h.quantile_us(0.99), h.max_us());
}

// Fault texts passed parse_haptic_fault(): names, numbers and signs, nothing that JSON would have to escape.
std::string to_json(const std::vector<StruckFault>& faults) {
  std::string json = "[";
  for (const StruckFault& fault : faults) {
    json += fmt::format(R"({}{{"fault":"{}","time_ns":{},"sequence":{}}})", json.size() > 1 ? "," : "", fault.fault,
                        fault.time_ns, fault.sequence);
  }
  return json + "]";
}

}  // namespace

std::string to_json(const HapticSummary& s) {
  std::string json =
      fmt::format(R"({{"device":"{}","axes":{},"rate_hz":{},"duration_s":{:.3f},"waited_s":{:.3f},"attachments":{})",
                  s.watching ? "haptic watcher" : "haptic", s.axes, s.rate_hz, s.duration_s, s.waited_s, s.attachments);
  json += fmt::format(R"(,"samples":{},"missed_periods":{},"latest_start_us":{:.1f},"skipped_samples":{})", s.samples,
                      s.missed_periods, s.latest_start_us, s.skipped_samples);
  json += fmt::format(R"(,"forces":{},"skipped_forces":{},"torn_reads":{},"silences":{})", s.forces, s.skipped_forces,
                      s.torn_reads, s.silences);
  json += fmt::format(R"(,"latency_us":{},"tick_latency_us":{})", to_json(s.latency), to_json(s.tick_latency));
  json += fmt::format(R"(,"max_force_n":{:.4f},"max_torque_nm":{:.4f},"work_j":{:.6f},"max_work_j":{:.6f})",
                      s.max_force_n, s.max_torque_nm, s.work_j, s.max_work_j);
  json += fmt::format(R"(,"phase":"{}","fault":"{}","gateway_faults":{},"motion_done":{},"faults":{}}})",
                      word(kPhases, s.last_phase), word(kFaults, s.last_fault), s.gateway_faults, s.motion_done,
                      to_json(s.faults));
  return json;
}

}  // namespace cellmirror::sim
