#include "app/proximity/collide_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console/display_names.hpp"
#include "app/console/put.hpp"
#include "app/proximity/pairs_report.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/microseconds.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kPairsListed = 12;  // frames that are shown one by one
constexpr std::uint64_t kMostChanges = 40;  // lines about frames in which something changes
constexpr std::size_t kMostPairs = 30;      // of the summary: those that touch in most frames
constexpr std::size_t kMostDoubt = 400;     // characters of a sentence
constexpr std::size_t kMostLeftOut = 6;     // pairs listed per reason

std::size_t tested_pairs(const collision::PairTable& pairs) {
  return static_cast<std::size_t>(
      std::count_if(pairs.pairs.begin(), pairs.pairs.end(),
                    [](const collision::Pair& pair) { return collision::is_tested(pair.state); }));
}

JsonWriter& begin_pair(JsonWriter& out, const collision::PairTable& pairs, std::uint32_t a, std::uint32_t b) {
  return out.begin_object().member("a", (*pairs.names)[a]).member("b", (*pairs.names)[b]);
}

void add(JsonWriter& out, const collision::PairTable& pairs, const NearPair& pair) {
  begin_pair(out, pairs, pair.a, pair.b)
      .member("distance_m", pair.distance_m)
      .member("point_a_m", pair.point_a_m)
      .member("point_b_m", pair.point_b_m);
  if (pair.doubtful) out.member("doubtful", true);
  out.end_object();
}

void add(JsonWriter& out, const collision::PairTable& pairs, const TouchingPair& pair) {
  begin_pair(out, pairs, pair.a, pair.b)
      .member("depth_m", pair.depth_m)
      .member("point_m", pair.point_m)
      .member("normal", pair.normal)
      .key("contacts")
      .begin_array();
  for (const TouchingPoint& point : pair.points) {
    out.begin_object()
        .member("point_m", point.point_m)
        .member("normal", point.normal)
        .member("depth_m", point.depth_m)
        .end_object();
  }
  out.end_array();
  if (pair.doubtful) out.member("doubtful", true);
  out.end_object();
}

}  // namespace

CollideJson::CollideJson(const CollideHeading& heading, const collision::PairTable& pairs, std::FILE* out)
    : pairs_(pairs), out_(out) {
  const std::size_t tested = tested_pairs(pairs);
  json_.begin_object()
      .member("cell", heading.cell)
      .member("bodies", pairs.bodies.size())
      .member("triangles", pairs.triangles)
      .member("pairs_tested", tested)
      .member("pairs_left_out", pairs.pairs.size() - tested)
      .member("pairs_rigid", pairs.rigid_pairs)
      .member("warning_distance_m", heading.warning_distance_m)
      .key("left_out")
      .begin_array();
  for (const collision::Pair& pair : pairs.pairs) {
    if (collision::is_tested(pair.state)) continue;
    begin_pair(json_, pairs, pair.a, pair.b).member("state", word_of(pair.state)).end_object();
  }
  json_.end_array().key("frames").begin_array();
  hand_out();
}

void CollideJson::hand_out(std::string_view behind) { put(out_, "{}{}", json_.take(), behind); }

void CollideJson::frame(const ProximityState& state) {
  json_.line().begin_object().key("collisions").begin_array();
  for (const TouchingPair& pair : state.touching) add(json_, pairs_, pair);
  json_.end_array().key("min_distance");
  if (const NearPair* nearest = state.nearest()) {
    add(json_, pairs_, *nearest);
  } else {
    json_.null();
  }
  json_.key("within_warning").begin_array();
  for (const NearPair& pair : state.near) {
    if (pair.within_warning) add(json_, pairs_, pair);
  }
  json_.end_array().member("doubts", state.doubts).end_object();
  hand_out();
}

void CollideJson::end(const CollideTotals& totals) {
  json_.line()
      .end_array()
      .key("summary")
      .begin_object()
      .member("frames", totals.frames)
      .member("frames_with_collisions", totals.frames_touching)
      .member("frames_in_doubt", totals.frames_in_doubt)
      .key("collisions")
      .begin_array();
  for (const auto& [pair, touch] : totals.touching) {
    begin_pair(json_, pairs_, pair.first, pair.second)
        .member("frames", touch.frames)
        .member("depth_m", touch.deepest_m)
        .member("frame", touch.deepest_frame)
        .end_object();
  }
  json_.end_array().key("min_distance");
  if (totals.nearest) {
    json_.begin_object().member("frame", totals.nearest_frame).key("pair");
    add(json_, pairs_, *totals.nearest);
    json_.end_object();
  } else {
    json_.null();
  }
  const HistogramSnapshot& times = totals.times;
  json_.member("time_mean_us", microseconds(times.mean()))
      .member("time_p50_us", microseconds(times.percentile(50)))
      .member("time_p99_us", microseconds(times.percentile(99)))
      .member("time_max_us", microseconds(times.max()))
      .end_object()
      .end_object();
  hand_out("\n");
}

CollideText::CollideText(const CollideHeading& heading, const collision::PairTable& pairs, std::FILE* out)
    : heading_(heading), names_(display_names(*pairs.short_names)), out_(out) {
  const std::size_t tested = tested_pairs(pairs);
  put(out_, "{}: {}, {}; {} tested, {} left out (--pairs says why), {} rigid\n", printable(heading.cell),
      number_of(pairs.bodies.size(), "body", "bodies"), number_of(pairs.triangles, "triangle"),
      number_of(tested, "pair"), pairs.pairs.size() - tested, pairs.rigid_pairs);
  left_out(pairs);
  for (const std::string& doubt : pairs.doubts) put(out_, "in doubt: {}\n", printable(doubt, kMostDoubt));
}

// Prints one line per reason, so that an untested pair is not mistaken for a pair without contact.
void CollideText::left_out(const collision::PairTable& pairs) {
  using collision::PairState;
  for (const PairState state : {PairState::neighbours, PairState::always, PairState::never, PairState::rule_ignore}) {
    std::size_t count = 0;
    std::string named;
    for (const collision::Pair& pair : pairs.pairs) {
      if (pair.state != state) continue;
      if (++count <= kMostLeftOut) named += (count == 1 ? "" : ", ") + pair_text(pair.a, pair.b);
    }
    if (count == 0) continue;
    if (count > kMostLeftOut) named += fmt::format(" and {} more", count - kMostLeftOut);
    put(out_, "  not tested, {} ({}): {}\n", word_of(state), count, named);
  }
}

std::string CollideText::pair_text(std::uint32_t a, std::uint32_t b) const { return names_[a] + " - " + names_[b]; }

void CollideText::frame(std::uint64_t number, const ProximityState& state) {
  if (heading_.frames <= kPairsListed) return whole_frame(number, state);
  changes(number, state);
}

void CollideText::whole_frame(std::uint64_t number, const ProximityState& state) {
  const NearPair* nearest = state.nearest();
  if (!state.touching.empty()) {
    put(out_, "frame {}: {} {}\n", number, state.touching.size(),
        state.touching.size() == 1 ? "collision" : "collisions");
  } else if (nearest != nullptr) {
    put(out_, "frame {}: free; nearest {} {:.4f} m{}\n", number, pair_text(nearest->a, nearest->b), nearest->distance_m,
        nearest->doubtful ? " at least" : "");
  } else {
    put(out_, "frame {}: no pair is tested\n", number);
  }
  for (const TouchingPair& pair : state.touching)
    put(out_, "  {}: {:.4f} m deep at {}{}\n", pair_text(pair.a, pair.b), pair.depth_m, point_text(pair.point_m),
        pair.doubtful ? ", in doubt" : "");
  for (const NearPair& pair : state.near) {
    if (pair.within_warning && pair.distance_m > 0.0 && &pair != nearest)
      put(out_, "  within {:g} m: {} {:.4f} m\n", heading_.warning_distance_m, pair_text(pair.a, pair.b),
          pair.distance_m);
  }
  for (const std::string& doubt : state.doubts) put(out_, "  in doubt: {}\n", printable(doubt, kMostDoubt));
}

void CollideText::changes(std::uint64_t number, const ProximityState& state) {
  std::set<BodyPair> now;
  for (const TouchingPair& pair : state.touching) {
    now.emplace(pair.a, pair.b);
    if (!touching_.contains({pair.a, pair.b}))
      change(fmt::format("frame {}: {} touch, {:.4f} m deep at {}{}\n", number, pair_text(pair.a, pair.b), pair.depth_m,
                         point_text(pair.point_m), pair.doubtful ? ", in doubt" : ""));
  }
  for (const BodyPair& pair : touching_) {
    if (!now.contains(pair)) change(fmt::format("frame {}: {} part\n", number, pair_text(pair.first, pair.second)));
  }
  touching_ = std::move(now);
}

void CollideText::change(const std::string& line) {
  if (++changes_ <= kMostChanges) std::fputs(line.c_str(), out_);
}

void CollideText::end(const CollideTotals& totals) {
  if (changes_ > kMostChanges) put(out_, "... and {} more changes (--json has them all)\n", changes_ - kMostChanges);
  put(out_, "\n{} {}: {} with collisions", totals.frames, totals.frames == 1 ? "frame" : "frames",
      totals.frames_touching);
  if (totals.frames_in_doubt > 0) put(out_, ", {} in doubt", totals.frames_in_doubt);
  put(out_, "\n");
  touching_summary(totals);
  if (totals.nearest)
    put(out_, "smallest distance {:.4f} m in frame {}: {}\n", totals.nearest->distance_m, totals.nearest_frame,
        pair_text(totals.nearest->a, totals.nearest->b));
  const HistogramSnapshot& times = totals.times;
  put(out_, "time a frame: mean {:.0f}, median {:.0f}, p99 {:.0f}, max {:.0f} us\n", microseconds(times.mean()),
      microseconds(times.percentile(50)), microseconds(times.percentile(99)), microseconds(times.max()));
}

void CollideText::touching_summary(const CollideTotals& totals) {
  std::vector<std::pair<BodyPair, TouchTotals>> pairs(totals.touching.begin(), totals.touching.end());
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.second.frames > b.second.frames; });
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  for (const auto& [pair, touch] : pairs)
    put(out_, "  {}: {} {}, at most {:.4f} m deep (frame {})\n", pair_text(pair.first, pair.second), touch.frames,
        touch.frames == 1 ? "frame" : "frames", touch.deepest_m, touch.deepest_frame);
  if (pairs.size() < totals.touching.size())
    put(out_, "  ... and {} more pairs (--json has them all)\n", totals.touching.size() - pairs.size());
}

plot::Figure figure(const CollideHeading& heading, const CollideTotals& totals) {
  plot::Figure out;
  out.title = "Distances in " + printable(heading.cell);
  out.subtitle = fmt::format("{}, {} with collisions; warning distance {:g} m", number_of(totals.frames, "frame"),
                             totals.frames_touching, heading.warning_distance_m);
  out.columns = 1;
  out.panel_width = 1400;
  plot::Line distance{"smallest distance", totals.distances.numbers(), totals.distances.values()};
  const double last = static_cast<double>(std::max<std::uint64_t>(totals.frames, 2));
  plot::Line warning{"warning distance", {1.0, last}, {heading.warning_distance_m, heading.warning_distance_m}};
  plot::Panel distances;
  distances.title = "Smallest distance of all pairs";
  distances.x = {"frame"};
  distances.y = {"distance [m]"};
  distances.lines = {std::move(distance), std::move(warning)};
  out.panels.push_back(std::move(distances));
  if (totals.frames_touching == 0) return out;
  plot::Line depth{"", totals.depths.numbers(), totals.depths.values()};
  for (double& value : depth.y) value = -value;
  plot::Panel depths;
  depths.title = "Depth of the deepest collision";
  depths.x = {"frame", false, 1.0, last};
  depths.y = {"depth [m]"};
  depths.lines = {std::move(depth)};
  out.panels.push_back(std::move(depths));
  return out;
}

}  // namespace cellmirror::app
