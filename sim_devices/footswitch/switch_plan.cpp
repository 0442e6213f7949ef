#include "sim_devices/footswitch/switch_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "rt_core/base/text.hpp"
#include "sim_devices/base/random.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMaxWords = 32768;
constexpr std::size_t kMaxAtOnce = kMaxSwitches;
constexpr double kShortestPress = 0.02;  // s
constexpr double kLongestPress = 0.12;

bool parse_change(std::string_view text, double at_s, SwitchChange& change) {
  if (text.size() < 2 || (text.back() != '+' && text.back() != '-')) return false;
  const auto number = parse_integer(text.substr(0, text.size() - 1));
  if (!number || *number < 1 || *number > kMaxSwitches || text.front() == '+') return false;
  change = {at_s, static_cast<std::uint32_t>(*number), text.back() == '+', false};
  return true;
}

Place place_of(std::string_view text, std::string_view word, std::string_view file) {
  const auto offset = static_cast<std::size_t>(word.data() - text.data());
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {std::string(file), static_cast<int>(1 + std::count(before.begin(), before.end(), '\n')),
          static_cast<int>(offset - line_start + 1)};
}

}  // namespace

std::vector<SwitchChange> parse_switch_sequence(std::string_view text, std::string_view file, double gap_s,
                                                Diagnostics& diagnostics) {
  std::vector<SwitchChange> plan;
  if (text.size() > kMaxSequenceText) {
    diagnostics.error({std::string(file)}, fmt::format("longer than {} bytes", kMaxSequenceText), "split it");
    return plan;
  }
  // Semicolons stand for blanks: a line of ./run's list of simulators has no quotes.
  std::string spaced(text);
  std::ranges::replace(spaced, ';', ' ');
  double now = 0;
  bool after_change = false;
  for (const std::string_view word : words(spaced, kMaxWords)) {
    if (const auto wait = parse_duration(word)) {
      now += *wait;
      after_change = false;
      continue;
    }
    if (after_change) now += gap_s;
    for (const std::string_view part : split(word, ',', kMaxAtOnce)) {
      SwitchChange change;
      if (!parse_change(part, now, change)) {
        diagnostics.error(
            place_of(spaced, word, file), fmt::format("'{}' is not a change of a switch", printable(word, 40)),
            fmt::format("write 1+ (closes), 1- (opens), 1+,2+ (at once) or a time, e.g. 500ms; switches 1 to {}",
                        kMaxSwitches));
        break;
      }
      plan.push_back(change);
    }
    after_change = true;
  }
  return plan;
}

double end_of(const std::vector<SwitchChange>& plan) {
  double end = 0;
  for (const SwitchChange& change : plan) end = std::max(end, change.at_s);
  return end;
}

void sort_by_time(std::vector<SwitchChange>& plan) {
  std::vector<std::size_t> order(plan.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return plan[a].at_s != plan[b].at_s ? plan[a].at_s < plan[b].at_s : a < b;
  });
  std::vector<SwitchChange> sorted;
  sorted.reserve(plan.size());
  for (const std::size_t i : order) sorted.push_back(plan[i]);
  plan = std::move(sorted);
}

std::vector<SwitchChange> random_presses(double presses_per_s, std::uint32_t inputs, double for_s, std::uint64_t seed) {
  std::vector<SwitchChange> plan;
  if (presses_per_s <= 0 || inputs == 0) return plan;
  Random random(seed);
  std::vector<double> free_at(inputs, 0.0);
  double now = 0;
  while (plan.size() + 2 <= kMaxSwitchChanges) {
    now += (0.5 + random.fraction()) / presses_per_s;
    const auto input = static_cast<std::uint32_t>(random.below(inputs));
    const double held = kShortestPress + (kLongestPress - kShortestPress) * random.fraction();
    const double begin = std::max(now, free_at[input]);
    if (begin + held > for_s) break;
    plan.push_back({begin, input + 1, true, false});
    plan.push_back({begin + held, input + 1, false, false});
    free_at[input] = begin + held + kShortestPress;
  }
  sort_by_time(plan);
  return plan;
}

std::vector<SwitchChange> with_bounces(const std::vector<SwitchChange>& plan, unsigned count, double within_s,
                                       std::uint64_t seed) {
  std::vector<SwitchChange> bouncing;
  Random random(seed);
  for (const SwitchChange& change : plan) {
    bouncing.push_back(change);
    std::vector<double> times;
    for (unsigned i = 0; i < 2 * count; ++i) times.push_back(change.at_s + within_s * random.fraction());
    std::sort(times.begin(), times.end());
    bool on = change.on;
    for (const double at : times) {
      on = !on;
      if (bouncing.size() >= kMaxSwitchChanges) break;
      bouncing.push_back({at, change.input, on, true});
    }
  }
  sort_by_time(bouncing);
  return bouncing;
}

}  // namespace cellmirror::sim
