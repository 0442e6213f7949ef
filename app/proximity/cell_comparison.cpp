#include "app/proximity/cell_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/proximity/collide_run.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::app {

namespace {

BodyNamePair names_of(const ProximityState& state, std::uint32_t a, std::uint32_t b) {
  const std::vector<std::string>& names = *state.names;
  return names[a] < names[b] ? BodyNamePair{names[a], names[b]} : BodyNamePair{names[b], names[a]};
}

void add(CellOverPostures& out, std::uint64_t posture, const ProximityState& state) {
  ++out.postures;
  if (!state.touching.empty()) ++out.touching;
  if (!state.doubts.empty()) ++out.in_doubt;
  for (const TouchingPair& pair : state.touching) {
    PairOverPostures& over = out.pairs[names_of(state, pair.a, pair.b)];
    if (!over.first_touch) over.first_touch = posture;
    over.deepest_m = std::max(over.deepest_m, pair.depth_m);
  }
  for (const NearPair& pair : state.near) {
    PairOverPostures& over = out.pairs[names_of(state, pair.a, pair.b)];
    if (over.nearest_m && *over.nearest_m <= pair.distance_m) continue;
    over.nearest_m = pair.distance_m;
    over.nearest_at = posture;
  }
}

bool touches(const std::optional<PairOverPostures>& pair) { return pair && pair->first_touch; }

bool differs(const PairChange& pair) {
  if (touches(pair.before) != touches(pair.after)) return true;
  if (touches(pair.before)) return false;
  if (!pair.before || !pair.after || !pair.before->nearest_m || !pair.after->nearest_m) return true;
  return std::abs(*pair.before->nearest_m - *pair.after->nearest_m) >= kEqualDistance;
}

double time_of(std::span<const double> times_s, std::uint64_t posture) {
  return posture < times_s.size() ? times_s[posture] : 0.0;
}

std::string distance_text(const std::optional<PairOverPostures>& pair, std::span<const double> times_s) {
  if (!pair || !pair->nearest_m) return "beyond the warning distance";
  return fmt::format("{:.3f} m at {:.2f} s", *pair->nearest_m, time_of(times_s, pair->nearest_at));
}

std::string touch_text(const PairOverPostures& pair, std::span<const double> times_s) {
  return fmt::format("from {:.2f} s on, {:.1f} mm deep", time_of(times_s, *pair.first_touch), 1e3 * pair.deepest_m);
}

void member(JsonWriter& out, const char* name, const std::optional<PairOverPostures>& pair,
            std::span<const double> times_s) {
  out.key(name);
  if (!pair) {
    out.null();
    return;
  }
  out.begin_object();
  if (pair->first_touch) {
    out.member("first_touch_s", time_of(times_s, *pair->first_touch)).member("deepest_m", pair->deepest_m);
  }
  if (pair->nearest_m) {
    out.member("nearest_m", *pair->nearest_m).member("nearest_s", time_of(times_s, pair->nearest_at));
  }
  out.end_object();
}

}  // namespace

std::optional<CellOverPostures> over_postures(const ProximityCell& cell, const std::string& postures) {
  const auto rows = open_postures(postures, cell);
  if (!rows) return std::nullopt;
  CollideInput input;
  input.cell = cell.compiled;
  input.settings = cell.loaded.collision;
  input.settings.active = true;
  collision::PairDerivation derivation(std::make_shared<geometry::SolidLibrary>());
  input.pairs = derivation.derive(*input.cell, input.settings, rows->beyond());
  CellOverPostures out;
  out.cell = cell.loaded.name;
  const auto run =
      run_collide(input, *rows, [&](std::uint64_t frame, const ProximityState& state) { add(out, frame - 1, state); });
  if (!run) return std::nullopt;
  return out;
}

std::vector<PairChange> compare(const CellOverPostures& before, const CellOverPostures& after) {
  std::map<BodyNamePair, PairChange> all;
  for (const auto& [bodies, pair] : before.pairs) all[bodies].before = pair;
  for (const auto& [bodies, pair] : after.pairs) all[bodies].after = pair;
  std::vector<PairChange> out;
  std::vector<PairChange> of_distance;
  for (auto& [bodies, pair] : all) {
    pair.bodies = bodies;
    if (differs(pair)) (touches(pair.before) != touches(pair.after) ? out : of_distance).push_back(pair);
  }
  out.insert(out.end(), of_distance.begin(), of_distance.end());
  return out;
}

std::string comparison_text(const CellOverPostures& before, const CellOverPostures& after,
                            std::span<const double> times_s) {
  std::string out = fmt::format("{} postures; bodies touch in {} of them in {}, in {} in {}\n", before.postures,
                                before.touching, before.cell, after.touching, after.cell);
  if (before.in_doubt + after.in_doubt > 0)
    out += fmt::format("{} and {} postures could not be settled for sure\n", before.in_doubt, after.in_doubt);
  const std::vector<PairChange> changes = compare(before, after);
  for (const PairChange& pair : changes) {
    const std::string bodies = fmt::format("{} - {}", pair.bodies.first, pair.bodies.second);
    if (touches(pair.before) == touches(pair.after)) {
      out += fmt::format("{}: {} instead of {}\n", bodies, distance_text(pair.after, times_s),
                         distance_text(pair.before, times_s));
    } else if (touches(pair.after)) {
      out += fmt::format("{}: touch only in the other cell, {}\n", bodies, touch_text(*pair.after, times_s));
    } else {
      out += fmt::format("{}: touch only in the recorded cell, {}\n", bodies, touch_text(*pair.before, times_s));
    }
  }
  if (changes.empty()) out += "no collision and no distance differs\n";
  return out;
}

std::string comparison_json(const CellOverPostures& before, const CellOverPostures& after,
                            std::span<const double> times_s, std::span<const std::string> changed_files) {
  JsonWriter out;
  out.begin_object().member("postures", before.postures);
  out.key("recorded").begin_object().member("cell", before.cell).member("touching", before.touching);
  out.member("in_doubt", before.in_doubt).end_object();
  out.key("other").begin_object().member("cell", after.cell).member("touching", after.touching);
  out.member("in_doubt", after.in_doubt).end_object();
  out.member("changed_files", changed_files);
  out.key("differences").begin_array();
  for (const PairChange& pair : compare(before, after)) {
    out.begin_object().member("a", pair.bodies.first).member("b", pair.bodies.second);
    member(out, "recorded", pair.before, times_s);
    member(out, "other", pair.after, times_s);
    out.end_object();
  }
  out.end_array().end_object();
  return out.take();
}

}  // namespace cellmirror::app
