#include "drivers/dds/proximity_diagnostics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "rt_core/base/contract.hpp"

namespace cellmirror::dds {

namespace {

const std::string& name_of(const ProximityState& state, std::uint32_t body) {
  CELLMIRROR_EXPECTS(state.names != nullptr && body < state.names->size());
  return (*state.names)[body];
}

// A touching pair may be in the list of near ones as well, with distance 0.
bool is_touching(const ProximityState& state, const NearPair& pair) {
  return std::any_of(state.touching.begin(), state.touching.end(),
                     [&](const TouchingPair& t) { return t.a == pair.a && t.b == pair.b; });
}

struct Sums {
  std::size_t within_warning = 0;  // that do not touch
  std::size_t doubtful = 0;
};

Sums sums_of(const ProximityState& state) {
  Sums sums;
  for (const TouchingPair& pair : state.touching) sums.doubtful += pair.doubtful ? 1 : 0;
  for (const NearPair& pair : state.near) {
    if (is_touching(state, pair)) continue;
    sums.within_warning += pair.within_warning ? 1 : 0;
    sums.doubtful += pair.doubtful ? 1 : 0;
  }
  return sums;
}

std::string counted_pairs(std::size_t n) { return n == 1 ? "1 pair" : fmt::format("{} pairs", n); }

double age_s(const ProximityState& state, Timestamp now) { return std::max(0.0, seconds(now - state.posture_time)); }

std::string verdict(const ProximityState& state, const Sums& sums, DiagnosticLevel level, double age) {
  switch (level) {
    case DiagnosticLevel::stale:
      return fmt::format("the last result is {:.1f} s old", age);
    case DiagnosticLevel::error:
      return counted_pairs(state.touching.size()) + (state.touching.size() == 1 ? " touches" : " touch");
    case DiagnosticLevel::warn:
      if (sums.within_warning == 0) return "not everything could be computed for sure";
      return fmt::format("{} within {:.3f} m", counted_pairs(sums.within_warning), state.warning_distance_m);
    case DiagnosticLevel::ok:
      break;
  }
  return fmt::format("nothing within {:.3f} m", state.warning_distance_m);
}

std::string in_words(const TouchingPair& pair) {
  return fmt::format("touching, depth {:.4f} m at ({:.4f}, {:.4f}, {:.4f}) m{}", pair.depth_m, pair.point_m.x(),
                     pair.point_m.y(), pair.point_m.z(), pair.doubtful ? ", in doubt" : "");
}

std::string in_words(const NearPair& pair) {
  std::string text = fmt::format("{:.4f} m", pair.distance_m);
  if (pair.closing_speed_m_s) text += fmt::format(", closing at {:.3f} m/s", *pair.closing_speed_m_s);
  if (pair.time_to_contact_s) text += fmt::format(", contact in {:.2f} s", *pair.time_to_contact_s);
  return text + (pair.doubtful ? ", in doubt" : "");
}

void name_pairs(const ProximityState& state, std::vector<KeyValue>& values) {
  const auto add = [&](const auto& pair) {
    values.push_back({fmt::format("{} - {}", name_of(state, pair.a), name_of(state, pair.b)), in_words(pair)});
  };
  std::size_t named = 0;
  for (const TouchingPair& pair : state.touching) {
    if (named++ < kPairsInDiagnostics) add(pair);
  }
  for (const NearPair& pair : state.near) {
    if (named < kPairsInDiagnostics && !is_touching(state, pair)) {
      ++named;
      add(pair);
    }
  }
}

}  // namespace

DiagnosticLevel collision_level(const ProximityState& state, Timestamp now) {
  if (age_s(state, now) > seconds(kFindingsStaleAfter)) return DiagnosticLevel::stale;
  if (!state.touching.empty()) return DiagnosticLevel::error;
  const bool noteworthy = std::any_of(state.near.begin(), state.near.end(),
                                      [](const NearPair& pair) { return pair.within_warning || pair.doubtful; });
  return noteworthy || !state.doubts.empty() ? DiagnosticLevel::warn : DiagnosticLevel::ok;
}

DiagnosticStatus collision_status(const ProximityState& state, Timestamp now) {
  const double age = age_s(state, now);
  const Sums sums = sums_of(state);
  DiagnosticStatus status;
  status.level = collision_level(state, now);
  status.name = "cellmirror: collisions";
  status.hardware_id = "cellmirror";
  status.message = verdict(state, sums, status.level, age);
  status.values = {{"age [s]", fmt::format("{:.4f}", age)},
                   {"tested pairs", fmt::format("{}", state.pairs)},
                   {"touching pairs", fmt::format("{}", state.touching.size())},
                   {"pairs within warning distance", fmt::format("{}", sums.within_warning)},
                   {"pairs in doubt", fmt::format("{}", sums.doubtful)},
                   {"warning distance [m]", fmt::format("{:.4f}", state.warning_distance_m)}};
  if (!state.touching.empty() || state.nearest() != nullptr) {
    const double smallest = state.touching.empty() ? state.nearest()->distance_m : 0.0;
    if (std::isfinite(smallest)) status.values.push_back({"smallest distance [m]", fmt::format("{:.4f}", smallest)});
  }
  name_pairs(state, status.values);
  for (std::size_t i = 0; i < std::min(state.doubts.size(), kPairsInDiagnostics); ++i) {
    status.values.push_back({"doubt", state.doubts[i]});
  }
  return status;
}

}  // namespace cellmirror::dds
