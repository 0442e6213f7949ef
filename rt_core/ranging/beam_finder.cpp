#include "rt_core/ranging/beam_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rt_core/cell/short_names.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;

constexpr double kShortest = 1e-6;      // m; shorter beams have no direction
constexpr double kLengthChange = 1e-9;  // m, from which the beam's solid is made again

std::int32_t node_at(const CompiledCell& cell, const std::string& path) {
  const auto found = std::ranges::find(*cell.paths, path);
  return found == cell.paths->end() ? -1 : static_cast<std::int32_t>(found - cell.paths->begin());
}

double distance_to_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double share = std::clamp(along.dot(point - a) / along.squaredNorm(), 0.0, 1.0);
  return (a + share * along - point).norm();
}

}  // namespace

void BeamFinder::adopt(const CompiledCell& cell, const SeenParts& parts) {
  beams_.clear();
  for (const LightBarrier& barrier : barriers_) {
    Beam& beam = beams_.emplace_back();
    beam.from = node_at(cell, barrier.from);
    beam.to = node_at(cell, barrier.to);
    beam.hints.resize(parts.size());
    beam.housing.assign(parts.size(), 0);
    if (beam.from < 0 || beam.to < 0) continue;
    const std::vector<std::uint8_t> emitter = housing_of(cell, beam.from, parts);
    const std::vector<std::uint8_t> receiver = housing_of(cell, beam.to, parts);
    for (std::size_t i = 0; i < parts.size(); ++i) beam.housing[i] = emitter[i] | receiver[i];
  }
}

std::span<const BarrierReading> BeamFinder::read(const CompiledCell& cell, const CellPoses& poses,
                                                 const SeenParts& parts, std::span<const std::string> short_names,
                                                 Timestamp posture_time) {
  readings_.resize(barriers_.size());
  for (std::size_t i = 0; i < barriers_.size(); ++i) {
    BarrierReading& reading = readings_[i];
    const bool was_interrupted = reading.interrupted;
    reading.name = barriers_[i].name;
    reading.posture_time = posture_time;
    read(beams_[i], barriers_[i], cell, poses, parts, short_names, reading);
    if (reading.interrupted && !was_interrupted) ++reading.interruptions;
  }
  return readings_;
}

void BeamFinder::read(Beam& beam, const LightBarrier& barrier, const CompiledCell& cell, const CellPoses& poses,
                      const SeenParts& parts, std::span<const std::string> short_names, BarrierReading& out) {
  out.object.clear();
  out.short_object.clear();
  out.placed = false;
  out.doubtful = true;
  out.interrupted = true;
  if (beam.from < 0 || beam.to < 0) return;
  const Vector3d a = poses.X_WN[static_cast<std::size_t>(beam.from)].translation();
  const Vector3d b = poses.X_WN[static_cast<std::size_t>(beam.to)].translation();
  const double length = (b - a).norm();
  if (!std::isfinite(length) || length < kShortest) return;
  if (std::abs(beam.length - length) > kLengthChange) {
    beam.solid = geometry::make_primitive(Shape::cylinder, {barrier.radius, length, 0.0});
    beam.length = length;
  }
  Pose X_WB = Pose::Identity();
  X_WB.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), b - a).toRotationMatrix();
  X_WB.translation() = 0.5 * (a + b);
  out.doubtful = parts.incomplete();
  out.placed = true;
  out.from = a;
  out.to = b;
  const auto near = [&](std::size_t i) {
    const double reach = parts.radius(i) + barrier.radius;
    return beam.housing[i] == 0 && !(distance_to_segment(parts.centre(i), a, b) > reach);
  };
  const auto blocks = [&](std::size_t i) { return near(i) && meets(beam, X_WB, parts, i); };
  // What was in the beam is most likely still there.
  std::size_t found = parts.size();
  if (beam.last < parts.size() && blocks(beam.last)) found = beam.last;
  for (std::size_t i = 0; i < parts.size() && found == parts.size(); ++i) {
    if (i != beam.last && blocks(i)) found = i;
  }
  out.interrupted = found < parts.size();
  if (!out.interrupted) return;
  beam.last = found;
  out.object = body_name(cell, parts.part(found).node);
  out.short_object = short_names[found];
}

bool BeamFinder::meets(Beam& beam, const Pose& X_WB, const SeenParts& parts, std::size_t part) {
  return geometry::touch(beam.solid, X_WB, *parts.part(part).solid, parts.X_WG(part), beam.hints[part]);
}

}  // namespace cellmirror::ranging
