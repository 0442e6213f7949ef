#include "rt_core/ranging/range_finder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/cell/short_names.hpp"
#include "rt_core/ranging/beam_finder.hpp"
#include "rt_core/ranging/cone_shape.hpp"
#include "rt_core/ranging/noise.hpp"
#include "rt_core/ranging/seen_parts.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNothing = 0xFFFFFFFFU;

struct Sensor {
  std::string id;
  std::string path;
  std::int32_t node = 0;
  SensorDefinition settings;
  std::optional<ConeShape> cone;  // none: the settings are not those of a cone
  std::vector<std::uint8_t> housing;
  Noise noise{0};
  // The last echo: most likely still the nearest, so the best start.
  std::uint32_t part = kNothing;
  std::uint32_t triangle = kNothing;
};

struct Candidate {
  double bound;  // m; nothing of the part is nearer
  std::uint32_t part;
};

}  // namespace

struct RangeFinder::State {
  std::shared_ptr<geometry::SolidLibrary> solids;
  std::shared_ptr<const CompiledCell> cell;
  SeenParts parts;
  std::vector<std::string> short_names;  // by part
  std::vector<Sensor> sensors;
  BeamFinder beams;
  std::vector<RangeReading> readings;
  std::vector<Candidate> candidates;

  void name_parts();
  void adopt_sensors();
  void read(Sensor& sensor, const Pose& X_WS, RangeReading& out);
  [[nodiscard]] Nearest nearest(Sensor& sensor, const Pose& X_WS);
  void collect(const Sensor& sensor, const Pose& X_WS, double limit);
};

RangeFinder::RangeFinder(std::shared_ptr<geometry::SolidLibrary> solids, std::vector<LightBarrier> barriers)
    : state_(std::make_unique<State>()) {
  CELLMIRROR_EXPECTS(solids != nullptr);
  state_->solids = std::move(solids);
  state_->beams.set_barriers(std::move(barriers));
}

RangeFinder::~RangeFinder() = default;

void RangeFinder::adopt(std::shared_ptr<const CompiledCell> cell) {
  CELLMIRROR_EXPECTS(cell != nullptr);
  state_->parts.adopt(*cell, *state_->solids);
  state_->cell = std::move(cell);
  state_->name_parts();
  state_->adopt_sensors();
  state_->beams.adopt(*state_->cell, state_->parts);
}

void RangeFinder::State::name_parts() {
  std::vector<std::int32_t> nodes;
  nodes.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) nodes.push_back(parts.part(i).node);
  short_names = short_body_names(*cell, nodes);
}

void RangeFinder::State::adopt_sensors() {
  std::vector<Sensor> before = std::move(sensors);
  sensors.clear();
  for (const CompiledSensor& from : cell->sensors) {
    Sensor sensor;
    sensor.id = from.name;
    sensor.path = (*cell->paths)[static_cast<std::size_t>(from.node)];
    sensor.node = from.node;
    sensor.settings = from.sensor;
    if (from.sensor.range_m > 0.0)
      sensor.cone = cone_shape({from.sensor.half_angle_rad, from.sensor.max_incidence_rad});
    sensor.housing = housing_of(*cell, from.node, parts);
    const auto old = std::ranges::find(before, sensor.path, &Sensor::path);
    const bool stays = old != before.end() && old->noise.seed() == from.sensor.seed;
    sensor.noise = stays ? old->noise : Noise(from.sensor.seed);
    sensors.push_back(std::move(sensor));
  }
}

std::span<const RangeReading> RangeFinder::read(const CellPoses& poses, Timestamp posture_time, Selection selection) {
  State& s = *state_;
  CELLMIRROR_EXPECTS(s.cell != nullptr && poses.X_WN.size() == s.cell->size());
  s.parts.place(*s.cell, poses);
  std::size_t count = 0;
  for (Sensor& sensor : s.sensors) {
    if (selection == Selection::active_sensors && !sensor.settings.active) continue;
    if (count == s.readings.size()) s.readings.emplace_back();
    RangeReading& reading = s.readings[count++];
    reading.posture_time = posture_time;
    s.read(sensor, poses.X_WN[static_cast<std::size_t>(sensor.node)], reading);
  }
  return {s.readings.data(), count};
}

std::span<const BarrierReading> RangeFinder::read_barriers(const CellPoses& poses, Timestamp posture_time) {
  State& s = *state_;
  CELLMIRROR_EXPECTS(s.cell != nullptr && poses.X_WN.size() == s.cell->size());
  return s.beams.read(*s.cell, poses, s.parts, s.short_names, posture_time);
}

// Strings are assigned to what is there: no heap memory once they have been as long.
void RangeFinder::State::read(Sensor& sensor, const Pose& X_WS, RangeReading& out) {
  const SensorDefinition& settings = sensor.settings;
  out.id = sensor.id;
  out.path = sensor.path;
  out.range_m = settings.range_m;
  out.blind_zone_m = settings.blind_zone_m;
  out.half_angle_rad = settings.half_angle_rad;
  out.X_WS = X_WS;
  out.distance_m.reset();
  out.point_m.setZero();
  out.object.clear();
  out.short_object.clear();
  out.in_blind_zone = false;
  out.doubtful = parts.incomplete() || !sensor.cone || !X_WS.matrix().allFinite();
  // Drawn for every reading, so that the sequence does not depend on the cell.
  const double noise = settings.noise_m > 0.0 ? settings.noise_m * sensor.noise.next() : 0.0;
  if (!sensor.cone || !X_WS.matrix().allFinite()) return;
  const Nearest found = nearest(sensor, X_WS);
  if (!found.found) return;
  const double exact = std::min(found.distance, settings.range_m);
  const double measured = std::max(0.0, exact + noise);
  if (measured > settings.range_m) return;  // the echo comes after the sensor has stopped to listen
  out.distance_m = measured;
  out.point_m = X_WS * found.p;
  out.object = body_name(*cell, parts.part(sensor.part).node);
  out.short_object = short_names[sensor.part];
  out.in_blind_zone = exact < settings.blind_zone_m;
}

Nearest RangeFinder::State::nearest(Sensor& sensor, const Pose& X_WS) {
  // The range is inclusive, regardless of rounding.
  constexpr double kRounding = 1e-12;
  Nearest best{sensor.settings.range_m * (1.0 + kRounding)};
  collect(sensor, X_WS, best.distance);
  const Pose X_SW = X_WS.inverse(Eigen::Isometry);
  const std::uint32_t last_part = sensor.part;
  const std::uint32_t last_triangle = sensor.triangle;
  for (const Candidate& candidate : candidates) {
    if (candidate.bound >= best.distance) continue;
    std::uint32_t triangle = candidate.part == last_part ? last_triangle : kNothing;
    const double before = best.distance;
    nearest_on_solid(*parts.part(candidate.part).solid, X_SW * parts.X_WG(candidate.part), *sensor.cone, best,
                     triangle);
    if (!(best.distance < before)) continue;
    sensor.part = candidate.part;
    sensor.triangle = triangle;
  }
  return best;
}

// The parts whose spheres reach into the cone, the last echo first, then by distance.
void RangeFinder::State::collect(const Sensor& sensor, const Pose& X_WS, double limit) {
  const Vector3d apex = X_WS.translation();
  const Vector3d axis = X_WS.linear().col(2);
  constexpr double kRounding = 1e-9;  // m, and in parts of the radius
  candidates.clear();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Vector3d d = parts.centre(i) - apex;
    const double radius = parts.radius(i) * (1.0 + kRounding) + kRounding;
    const double squared = d.squaredNorm();
    const double reach = limit + radius;
    if (!(squared < reach * reach)) continue;
    const double along = d.dot(axis);
    const double across = std::sqrt(std::max(0.0, squared - along * along));
    if (sensor.cone->cosine * across - sensor.cone->sine * along > radius || sensor.housing[i] != 0) continue;
    const double bound = i == sensor.part ? -1.0 : std::max(0.0, std::sqrt(squared) - radius);
    candidates.push_back({bound, static_cast<std::uint32_t>(i)});
  }
  std::ranges::sort(candidates, {}, &Candidate::bound);
}

}  // namespace cellmirror::ranging
