#include "drivers/dds/findings_markers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cellmirror::dds {

namespace {

constexpr MarkerColour kRed{0.9F, 0.1F, 0.1F, 1.0F};
constexpr MarkerColour kOrange{1.0F, 0.55F, 0.0F, 1.0F};
constexpr MarkerColour kGreen{0.1F, 0.7F, 0.2F, 1.0F};
constexpr MarkerColour kBlue{0.2F, 0.4F, 0.9F, 1.0F};
constexpr float kConeAlpha = 0.35F;
constexpr double kLineWidth = 0.005;       // m
constexpr double kContactDiameter = 0.02;  // m
constexpr double kEchoDiameter = 0.015;    // m
constexpr int kConeSides = 8;

Marker marker(RosTime stamp, std::string ns, std::int32_t id, MarkerType type, MarkerColour colour) {
  Marker made;
  made.header = {stamp, "world"};
  made.ns = std::move(ns);
  made.id = id;
  made.type = type;
  made.colour = colour;
  made.lifetime_ns = kMarkerLifetimeNs;
  return made;
}

MarkerPoint point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

void add_if_any(Marker& made, MarkerArray& message) {
  if (!made.points.empty()) message.markers.push_back(std::move(made));
}

Marker distances(RosTime stamp, const ProximityState& state) {
  Marker lines = marker(stamp, "distances", 0, MarkerType::line_list, kGreen);
  lines.scale = {kLineWidth, 0, 0};
  for (const NearPair& pair : state.near) {
    if (lines.points.size() >= 2 * kMaxDrawnPairs) break;
    if (!pair.point_a_m.allFinite() || !pair.point_b_m.allFinite() || pair.distance_m <= 0) continue;
    lines.points.insert(lines.points.end(), {point(pair.point_a_m), point(pair.point_b_m)});
    lines.colours.insert(lines.colours.end(), 2, pair.within_warning ? kOrange : kGreen);
  }
  return lines;
}

Marker contacts(RosTime stamp, const ProximityState& state) {
  Marker spheres = marker(stamp, "contacts", 0, MarkerType::sphere_list, kRed);
  spheres.scale = {kContactDiameter, kContactDiameter, kContactDiameter};
  const auto add = [&](const Eigen::Vector3d& p) {
    if (p.allFinite() && spheres.points.size() < kMaxDrawnContacts) spheres.points.push_back(point(p));
  };
  for (const TouchingPair& pair : state.touching) {
    if (pair.points.empty()) add(pair.point_m);
    for (const TouchingPoint& contact : pair.points) add(contact.point_m);
  }
  return spheres;
}

// The cone's mantle: its edge lies on the sphere of the reading around the apex.
void add_cone(const RangeReading& reading, double length, std::vector<MarkerPoint>& points) {
  const double radius = length * std::sin(reading.half_angle_rad);
  const double height = length * std::cos(reading.half_angle_rad);
  const auto edge = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / kConeSides;
    return point(reading.X_WS * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), height));
  };
  const MarkerPoint apex = point(reading.X_WS.translation());
  for (int i = 0; i < kConeSides; ++i) points.insert(points.end(), {apex, edge(i), edge(i + 1)});
}

bool is_finite(const RangeReading& reading) {
  return reading.X_WS.matrix().allFinite() && std::isfinite(reading.half_angle_rad) && std::isfinite(reading.range_m) &&
         (!reading.distance_m || (std::isfinite(*reading.distance_m) && reading.point_m.allFinite()));
}

}  // namespace

void fill_proximity_markers(RosTime stamp, const ProximityState& state, MarkerArray& message) {
  message.markers.clear();
  Marker lines = distances(stamp, state);
  Marker spheres = contacts(stamp, state);
  add_if_any(lines, message);
  add_if_any(spheres, message);
}

void fill_range_markers(RosTime stamp, std::span<const RangeReading> readings, MarkerArray& message) {
  message.markers.clear();
  const auto faint = [](MarkerColour colour) { return MarkerColour{colour[0], colour[1], colour[2], kConeAlpha}; };
  std::array cones = {marker(stamp, "cones", 0, MarkerType::triangle_list, faint(kBlue)),
                      marker(stamp, "cones", 1, MarkerType::triangle_list, faint({0.6F, 0.6F, 0.6F, 1.0F})),
                      marker(stamp, "cones", 2, MarkerType::triangle_list, faint(kRed))};
  Marker echoes = marker(stamp, "echoes", 0, MarkerType::sphere_list, kBlue);
  echoes.scale = {kEchoDiameter, kEchoDiameter, kEchoDiameter};
  std::size_t drawn = 0;
  for (const RangeReading& reading : readings) {
    if (!is_finite(reading) || drawn++ >= kMaxDrawnCones) continue;
    const bool unsure = reading.in_blind_zone || reading.doubtful;
    const std::size_t colour = unsure ? 2 : !reading.distance_m ? 1 : 0;
    add_cone(reading, reading.distance_m.value_or(reading.range_m), cones[colour].points);
    if (reading.distance_m) echoes.points.push_back(point(reading.point_m));
  }
  for (Marker& cone : cones) add_if_any(cone, message);
  add_if_any(echoes, message);
}

void ShownMarkers::update(MarkerArray& message) {
  std::set<std::pair<std::string, std::int32_t>> now;
  for (const Marker& made : message.markers) {
    now.emplace(made.ns, made.id);
    shown_.erase({made.ns, made.id});
  }
  for (const auto& [ns, id] : shown_) {
    Marker gone;
    gone.header.frame_id = "world";
    gone.ns = ns;
    gone.id = id;
    gone.action = MarkerAction::remove;
    message.markers.push_back(std::move(gone));
  }
  shown_ = std::move(now);
}

}  // namespace cellmirror::dds
