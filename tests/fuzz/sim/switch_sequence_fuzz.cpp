// Sequences of sim_footswitch: refused with words, or changes of switches that exist, in order of time.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim_devices/footswitch/switch_bits.hpp"
#include "sim_devices/footswitch/switch_plan.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const auto plan = sim::parse_switch_sequence({reinterpret_cast<const char*>(data), size}, "fuzz", 0.1, diagnostics);
  double before = 0;
  for (const sim::SwitchChange& change : plan) {
    if (change.input < 1 || change.input > sim::kMaxSwitches || !(change.at_s >= before)) std::abort();
    before = change.at_s;
  }
  if (plan.size() > 2000) return 0;
  std::array<std::byte, 5> memory{};
  memory[4] = std::byte{0xa5};
  const auto bouncing = sim::with_bounces(plan, 2, 0.002, 1);
  if (bouncing.size() != 5 * plan.size()) std::abort();
  sim::put_switches(std::span(memory).first(4), bouncing);
  if (memory[4] != std::byte{0xa5}) std::abort();
  return 0;
}
