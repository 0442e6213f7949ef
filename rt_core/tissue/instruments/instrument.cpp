#include "rt_core/tissue/instruments/instrument.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

bool is_pose(const Pose& X) {
  if (!X.matrix().allFinite()) return false;
  const Eigen::Matrix3d& R = X.linear();
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 && R.determinant() > 0;
}

double bounded(double value, double low, double high, double otherwise) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

}  // namespace

void Instrument::set_action(const InstrumentAction& wanted) {
  if (acting && (heating || stroke_area_m2 > 0)) {
    next_action = wanted;
  } else {
    begin_action(wanted);
  }
}

void Instrument::begin_action(const InstrumentAction& wanted) {
  action = wanted;
  next_action.reset();
  acting = false;
  acted = false;
  cut_front_m = 0;
  stroke_area_m2 = 0;
  heating = false;
  heated_m3 = 0;
  swept = false;
}

void Instrument::set_shape(const InstrumentShape& wanted) {
  const InstrumentShape usual;
  shape.shaft_radius_m = bounded(wanted.shaft_radius_m, 1e-4, 0.1, usual.shaft_radius_m);
  shape.effector_radius_m = bounded(wanted.effector_radius_m, 1e-4, 0.1, usual.effector_radius_m);
  shape.effector_length_m = bounded(wanted.effector_length_m, 1e-4, 1.0, usual.effector_length_m);
  shape.shaft_length_m = bounded(wanted.shaft_length_m, shape.effector_length_m, 3.0, shape.effector_length_m);
}

void Instrument::set_clip(const ClipDefinition& definition) {
  clip = definition;
  auto vertices = std::make_shared<std::vector<Eigen::Vector3f>>();
  for (const Vector3d& p : definition.shape.vertices) vertices->push_back(p.cast<float>());
  clip_vertices = std::move(vertices);
  clip_triangles = std::make_shared<std::vector<std::array<std::uint32_t, 3>>>(definition.shape.triangles);
}

void Instrument::reset() {
  Instrument fresh;
  fresh.slot = slot;
  fresh.shape = shape;
  fresh.action = next_action.value_or(action);
  fresh.clip = std::move(clip);
  fresh.clip_vertices = std::move(clip_vertices);
  fresh.clip_triangles = std::move(clip_triangles);
  *this = std::move(fresh);
}

LimitActions Instrument::move_to(const InstrumentPose& pose, Limits& limits, EventLog& log) {
  if (next_action && !acting) begin_action(*next_action);
  acted = acting;
  effective = false;
  speed.setZero();
  turning.setZero();
  if (!is_pose(pose.X_WT)) {
    limits.count(TissueLimit::instrument_speed);
    X_start = X_end;
    return {};
  }
  const double q = action.joint < pose.q.size() ? pose.q[action.joint] : std::nan("");
  acting = !next_action && std::isfinite(q) && action.triggered(q);
  if (!tracked) {
    tracked = true;
    X_start = pose.X_WT;
    X_end = pose.X_WT;
    effective = true;
    return {};
  }
  X_start = X_end;
  X_end = pose.X_WT;
  effective = !discard_next;
  discard_next = false;
  Vector3d way = X_end.translation() - X_start.translation();
  const LimitActions beyond = limits.examine(TissueLimit::instrument_speed, way.norm() / kStep_s, log,
                                             {.instrument = slot}, X_end.translation());
  if (beyond.has(TissueLimitAction::clamp)) {
    way *= limits.value(TissueLimit::instrument_speed) * kStep_s / way.norm();
    X_end.translation() = X_start.translation() + way;
  }
  if (beyond.has(TissueLimitAction::discard)) effective = false;
  if (beyond.has(TissueLimitAction::release)) release_requested = true;
  speed = way / kStep_s;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_end.linear() * X_start.linear().transpose()));
  turning = turn.angle() / kStep_s * turn.axis();
  constexpr double kFastestTurn = 50.0;  // rad/s
  if (turning.norm() > kFastestTurn) turning *= kFastestTurn / turning.norm();
  return beyond;
}

void Instrument::absent() {
  acted = acting;
  acting = false;
  effective = false;
  tracked = false;
}

double Instrument::contact_radius() const {
  constexpr double kJaw = 0.2;  // of the effector's radius
  constexpr double kHook = 0.3;
  if (has_jaws()) return kJaw * shape.effector_radius_m;
  return action.kind == InstrumentKind::hook ? kHook * shape.effector_radius_m : shape.effector_radius_m;
}

Capsule Instrument::capsule(std::size_t which) const {
  const double length = shape.effector_length_m;
  if (which == 0) {
    return {X_start * Vector3d(0, 0, -shape.shaft_length_m), X_start * Vector3d(0, 0, -length), shape.shaft_radius_m};
  }
  const double radius = contact_radius();
  const double side = which == 1 ? 1.0 : -1.0;
  const double open = has_jaws() ? side * (shape.effector_radius_m - radius) : 0.0;
  return {X_start * Vector3d(0, 0, -std::max(length, radius)), X_start * Vector3d(0, open, -radius), radius};
}

Capsule Instrument::effector() const {
  const double radius = shape.effector_radius_m;
  return {X_start * Vector3d(0, 0, -std::max(shape.effector_length_m, radius)), X_start * Vector3d(0, 0, -radius),
          radius};
}

}  // namespace cellmirror::tissue
