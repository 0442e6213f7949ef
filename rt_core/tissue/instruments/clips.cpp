#include "rt_core/tissue/instruments/clips.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kClipReach = 0.003;     // m, beyond the clip's legs and the vessel's radius
constexpr double kClosingSpeed = 0.02;   // m/s
constexpr double kClosedShare = 0.65;    // of the distance of a vessel's sides: closer, thin ducts grow long and buckle
constexpr double kMostClosingForce = 2;  // N

}  // namespace

void Clips::reset() { clips_.clear(); }

Pose Clips::frame(const Body& body, const std::array<EmbeddedPoint, 3>& points) {
  const Vector3d origin = body.position(points[0]);
  const Vector3d x = (body.position(points[1]) - origin).normalized();
  const Vector3d z = x.cross(body.position(points[2]) - origin).normalized();
  Pose X_WF = Pose::Identity();
  X_WF.translation() = origin;
  if (!x.allFinite() || !z.allFinite() || z.norm() < 0.5) return X_WF;
  X_WF.linear().col(0) = x;
  X_WF.linear().col(1) = z.cross(x);
  X_WF.linear().col(2) = z;
  return X_WF;
}

bool Clips::place(const Instrument& instrument, std::span<DeformableObject> objects, Vessels& vessels,
                  InstrumentContacts& finder, EventLog& log) {
  if (clips_.size() >= kMostClips) return false;
  const Pose X_WC = instrument.X_end * instrument.clip.X_TC;
  const double half = 0.5 * instrument.clip.length_m;
  const Vector3d middle = X_WC * Vector3d(0, 0, half);
  Clip clip;
  clip.vertices = instrument.clip_vertices;
  clip.triangles = instrument.clip_triangles;
  const auto on = vessels.nearest(objects, TissueAttribute::clip, middle, half + kClipReach);
  double arc = 0;
  if (on) {
    const VesselSample& sample = vessels.sample(on->vessel, on->sample);
    clip.object = vessels.object_of(on->vessel);
    const Body& body = *objects[clip.object].body;
    clip.frame = {sample.centre, sample.around[0], sample.around[2]};
    clip.closes_vessel = true;
    // The pair of opposite sides between which the legs are.
    const auto along = [&](std::size_t i) {
      return std::abs((body.position(sample.around[i]) - body.position(sample.around[i + 1]))
                          .normalized()
                          .dot(X_WC.linear().col(1)));
    };
    const std::size_t pair = along(0) >= along(2) ? 0 : 2;
    clip.sides = {sample.around[pair], sample.around[pair + 1]};
    clip.closed_m = kClosedShare * (body.position(clip.sides[0]) - body.position(clip.sides[1])).norm();
    arc = on->arc_m;
    vessels.close(*on);
  } else {
    std::vector<SurfacePoint> found;
    finder.near_effector(instrument, objects, TissueAttribute::clip, instrument.shape.effector_radius_m + kClipReach,
                         0.0, 1, found);
    if (found.empty()) return false;
    clip.object = found.front().object;
    clip.frame = found.front().embedded;
  }
  // Its middle goes to where it holds; it keeps the direction in which it was set.
  const Pose X_WF = frame(*objects[clip.object].body, clip.frame);
  Pose X_WS = X_WC;
  if (on) X_WS.translation() = X_WF.translation() - X_WC.linear() * Vector3d(0, 0, half);
  clip.X_FC = X_WF.inverse() * X_WS;
  clips_.push_back(clip);
  log.add(TissueEventKind::clip,
          {.instrument = instrument.slot,
           .object = static_cast<int>(clip.object),
           .part = on ? std::string_view(vessels.description(on->vessel).name) : std::string_view()},
          X_WF.translation(), arc);
  return true;
}

void Clips::add(ConstraintSystem& system, std::span<DeformableObject> objects, double dt) {
  for (Clip& clip : clips_) {
    const DeformableObject& object = objects[clip.object];
    clip.has_row = clip.closes_vessel && object.calculates() && object.steps_now;
    if (!clip.has_row) continue;
    const Vector3d way = object.body->position(clip.sides[1]) - object.body->position(clip.sides[0]);
    const double length = way.norm();
    clip.has_row = length > 1e-6;
    if (!clip.has_row) continue;
    ConstraintSystem::Push push;
    push.normal = way / length;
    push.bias = std::min((length - clip.closed_m) / dt, kClosingSpeed);
    push.most = kMostClosingForce * dt;
    push.impulse = clip.impulse;
    add_terms(system, object, clip.object, clip.sides[0], 1.0);
    add_terms(system, object, clip.object, clip.sides[1], -1.0);
    clip.row = system.add(push);
  }
}

void Clips::take(const ConstraintSystem& system) {
  for (Clip& clip : clips_) {
    if (clip.has_row) clip.impulse = system.push(clip.row).impulse;
  }
}

void Clips::follow_cuts(std::span<const DeformableObject> objects) {
  for (Clip& clip : clips_) {
    const Body& body = *objects[clip.object].body;
    for (EmbeddedPoint& point : clip.frame) body.follow_cuts(point);
    for (EmbeddedPoint& point : clip.sides) body.follow_cuts(point);
  }
}

void Clips::forget_impulses() {
  for (Clip& clip : clips_) clip.impulse = 0;
}

void Clips::view(std::span<const DeformableObject> objects, std::vector<TissueClip>& clips) const {
  clips.clear();
  for (const Clip& clip : clips_) {
    TissueClip shown;
    shown.X_WC = frame(*objects[clip.object].body, clip.frame) * clip.X_FC;
    shown.vertices = clip.vertices;
    shown.triangles = clip.triangles;
    shown.closes_vessel = clip.closes_vessel;
    clips.push_back(std::move(shown));
  }
}

}  // namespace cellmirror::tissue
