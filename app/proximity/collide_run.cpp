#include "app/proximity/collide_run.hpp"

#include <chrono>
#include <limits>

namespace cellmirror::app {

namespace {

void add_up(CollideTotals& totals, const ProximityState& state) {
  ++totals.frames;
  if (!state.touching.empty()) ++totals.frames_touching;
  bool doubt = !state.doubts.empty();
  double deepest = std::numeric_limits<double>::quiet_NaN();
  for (const TouchingPair& pair : state.touching) {
    doubt = doubt || pair.doubtful;
    deepest = std::fmin(deepest, -pair.depth_m);
    TouchTotals& touch = totals.touching[{pair.a, pair.b}];
    if (touch.frames++ == 0 || pair.depth_m > touch.deepest_m) {
      touch.deepest_m = pair.depth_m;
      touch.deepest_frame = totals.frames;
    }
  }
  if (doubt) ++totals.frames_in_doubt;
  const NearPair* nearest = state.nearest();
  totals.distances.add(nearest != nullptr ? nearest->distance_m : std::numeric_limits<double>::quiet_NaN());
  totals.depths.add(deepest);
  if (nearest == nullptr || (totals.nearest && totals.nearest->distance_m <= nearest->distance_m)) return;
  totals.nearest = *nearest;
  totals.nearest_frame = totals.frames;
}

}  // namespace

Result<CollideTotals> run_collide(const CollideInput& input, Postures& postures, const FrameSink& sink) {
  collision::Checker checker;
  checker.adopt(input.cell, input.pairs, input.settings);
  CellPoses poses;
  poses.reserve(input.cell->size());
  LatencyHistogram times;
  CollideTotals totals;
  for (;;) {
    const auto more = postures.next();
    if (!more) return std::unexpected(more.error());
    if (!*more) break;
    const auto begin = std::chrono::steady_clock::now();
    compute_poses(*input.cell, postures.q(), poses);
    const ProximityState& state = checker.check(poses, Timestamp{});
    times.record(std::chrono::duration_cast<Nanoseconds>(std::chrono::steady_clock::now() - begin));
    add_up(totals, state);
    sink(totals.frames, state);
  }
  totals.times = times.snapshot();
  totals.counters = checker.counters();
  return totals;
}

}  // namespace cellmirror::app
