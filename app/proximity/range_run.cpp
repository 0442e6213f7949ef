#include "app/proximity/range_run.hpp"

#include <chrono>
#include <limits>

#include "rt_core/base/contract.hpp"
#include "rt_core/ranging/range_finder.hpp"

namespace cellmirror::app {

namespace {

void add_up(SensorTotals& totals, const RangeReading& reading, std::uint64_t frame) {
  totals.distances.add(reading.distance_m.value_or(std::numeric_limits<double>::quiet_NaN()));
  if (reading.doubtful) ++totals.in_doubt;
  if (!reading.distance_m) return;
  const double distance = *reading.distance_m;
  if (reading.in_blind_zone) ++totals.in_blind_zone;
  if (totals.seen == 0 || distance < totals.smallest_m) {
    totals.smallest_m = distance;
    totals.smallest_frame = frame;
    totals.smallest_object = reading.short_object;
  }
  totals.largest_m = totals.seen == 0 ? distance : std::max(totals.largest_m, distance);
  ++totals.seen;
}

}  // namespace

Result<RangeTotals> run_range(const std::shared_ptr<const CompiledCell>& cell,
                              const std::shared_ptr<geometry::SolidLibrary>& solids, Postures& postures,
                              const ReadingSink& sink) {
  ranging::RangeFinder finder(solids);
  finder.adopt(cell);
  CellPoses poses;
  poses.reserve(cell->size());
  LatencyHistogram times;
  RangeTotals totals;
  totals.sensors.resize(cell->sensors.size());
  for (;;) {
    const auto more = postures.next();
    if (!more) return std::unexpected(more.error());
    if (!*more) break;
    const auto begin = std::chrono::steady_clock::now();
    compute_poses(*cell, postures.q(), poses);
    const auto readings = finder.read(poses, Timestamp{}, ranging::Selection::all_sensors);
    times.record(std::chrono::duration_cast<Nanoseconds>(std::chrono::steady_clock::now() - begin));
    CELLMIRROR_EXPECTS(readings.size() == totals.sensors.size());
    ++totals.frames;
    for (std::size_t i = 0; i < readings.size(); ++i) add_up(totals.sensors[i], readings[i], totals.frames);
    sink(totals.frames, readings);
  }
  totals.times = times.snapshot();
  return totals;
}

}  // namespace cellmirror::app
