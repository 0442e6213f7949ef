#include "app/report/status_ranges.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "app/report/status_collisions.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

// Null: it is switched off, or was switched on just now.
const RangeReading* reading_of(const RangeReport& report, const CompiledSensor& sensor, const std::string& path) {
  if (!sensor.sensor.active || !report.readings) return nullptr;
  const auto& readings = report.readings->readings;
  const auto found = std::ranges::find(readings, path, &RangeReading::path);
  return found == readings.end() ? nullptr : &*found;
}

json sensor_json(const CompiledSensor& sensor, const std::string& path, const RangeReading* reading, Timestamp now) {
  json out = {{"id", sensor.name},
              {"path", path},
              {"active", sensor.sensor.active},
              {"range_m", sensor.sensor.range_m},
              {"blind_zone_m", sensor.sensor.blind_zone_m},
              {"half_angle_rad", sensor.sensor.half_angle_rad},
              {"distance_m", nullptr},
              {"point_m", nullptr},
              {"object", nullptr},
              {"object_short", nullptr},
              {"in_blind_zone", false},
              {"doubtful", false},
              {"age_s", nullptr}};
  if (reading == nullptr) return out;
  out["age_s"] = seconds(now - reading->posture_time);
  out["doubtful"] = reading->doubtful;
  if (!reading->distance_m) return out;
  out["distance_m"] = *reading->distance_m;
  out["point_m"] = {reading->point_m.x(), reading->point_m.y(), reading->point_m.z()};
  out["object"] = reading->object;
  out["object_short"] = reading->short_object.empty() ? reading->object : reading->short_object;
  out["in_blind_zone"] = reading->in_blind_zone;
  return out;
}

json short_of(const BarrierReading& barrier) {
  if (barrier.object.empty()) return nullptr;
  return barrier.short_object.empty() ? barrier.object : barrier.short_object;
}

json barriers_json(const std::vector<BarrierReading>& barriers, Timestamp now) {
  json out = json::array();
  for (const BarrierReading& barrier : barriers) {
    out.push_back({{"name", barrier.name},
                   {"interrupted", barrier.interrupted},
                   {"interruptions", barrier.interruptions},
                   {"object", barrier.object.empty() ? json(nullptr) : json(barrier.object)},
                   {"object_short", short_of(barrier)},
                   {"doubtful", barrier.doubtful},
                   {"age_s", seconds(now - barrier.posture_time)}});
  }
  return out;
}

}  // namespace

json ranges_json(const RangeReport& report, const CellState& cell_state, Timestamp now) {
  const CompiledCell& cell = *cell_state.cell;
  json sensors = json::array();
  for (const CompiledSensor& sensor : cell.sensors) {
    const std::string& path = (*cell.paths)[static_cast<std::size_t>(sensor.node)];
    sensors.push_back(sensor_json(sensor, path, reading_of(report, sensor, path), now));
  }
  const bool known = report.readings != nullptr;
  return {{"sendmode", static_cast<int>(cell_state.range_send_mode)},
          {"age_s", known ? json(seconds(now - report.readings->posture_time)) : json(nullptr)},
          {"age_ms", percentiles_json(report.age, Nanoseconds(1'000'000))},
          {"compute_us", percentiles_json(report.compute, Nanoseconds(1'000))},
          {"rate_hz", report.rate_hz},
          {"skipped", report.skipped},
          {"sensors", std::move(sensors)},
          {"light_barriers", known ? barriers_json(report.readings->barriers, now) : json::array()}};
}

}  // namespace cellmirror::app
