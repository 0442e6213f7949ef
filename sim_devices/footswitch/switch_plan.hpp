// The timed changes of the foot switches: from text, from the command line, or random.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::sim {

inline constexpr std::uint32_t kMaxSwitches = 512;
inline constexpr std::size_t kMaxSwitchChanges = 1'000'000;
inline constexpr std::size_t kMaxSequenceText = 65536;

struct SwitchChange {
  double at_s = 0;
  std::uint32_t input = 1;  // from 1, as in BININP1
  bool on = false;
  bool bounce = false;  // caused by contact bounce
};

// "1+ 2+ 500ms 1-,2- ...": N+ closes, N- opens input N; changes joined by commas are simultaneous, the next ones follow
// after `gap_s`, or after the time between them. Changes in their order.
[[nodiscard]] std::vector<SwitchChange> parse_switch_sequence(std::string_view text, std::string_view file,
                                                              double gap_s, Diagnostics& diagnostics);
// Until when a sequence lasts: the time of its last change, and waits behind it.
[[nodiscard]] double end_of(const std::vector<SwitchChange>& plan);

// `presses` a second in all, of inputs 1 to `inputs`, each held for 20 to 120 ms; every input is off at the end.
[[nodiscard]] std::vector<SwitchChange> random_presses(double presses_per_s, std::uint32_t inputs, double for_s,
                                                       std::uint64_t seed);

// Each change becomes the change, and `count` times back and forth within `within_s` after it.
[[nodiscard]] std::vector<SwitchChange> with_bounces(const std::vector<SwitchChange>& plan, unsigned count,
                                                     double within_s, std::uint64_t seed);

// Sorted by time; those of one instant stay in their order.
void sort_by_time(std::vector<SwitchChange>& plan);

}  // namespace cellmirror::sim
