#include "rt_core/tissue/instruments/grip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kJawReach = 0.002;         // m beyond the effector's surface that jaws take in
constexpr double kHeldSpacing = 0.002;      // m
constexpr double kLostBeyond = 0.004;       // m beyond the effector's surface
constexpr double kCorrection = 0.3;         // part of an error that a step undoes
constexpr double kFastestCorrection = 0.2;  // m/s
constexpr double kGripSoftness = 0.02;

double distance_from_axis(const Instrument& instrument, const Vector3d& p_T) {
  const Vector3d on_axis(0, 0, std::clamp(p_T.z(), -instrument.shape.effector_length_m, 0.0));
  return (p_T - on_axis).norm();
}

}  // namespace

void update_grip(Instrument& instrument, std::span<DeformableObject> objects, InstrumentContacts& finder,
                 EventLog& log) {
  const bool grips = instrument.action.kind == InstrumentKind::gripper && instrument.acting;
  if (!grips || instrument.release_requested) release_grip(instrument, log);
  instrument.release_requested = false;
  if (!grips || !instrument.effective || !instrument.started()) return;
  std::vector<SurfacePoint> found;
  finder.near_effector(instrument, objects, TissueAttribute::grasp, instrument.shape.effector_radius_m + kJawReach,
                       kHeldSpacing, kMostHeldPoints, found);
  if (found.empty()) return;
  const Pose X_TW = instrument.X_start.inverse();
  for (const SurfacePoint& point : found) {
    HeldPoint held;
    held.point = point;
    held.p_T = X_TW * position(objects[point.object], point);
    instrument.held.push_back(held);
  }
  log.add(TissueEventKind::grip, {.instrument = instrument.slot, .object = static_cast<int>(found.front().object)},
          position(objects[found.front().object], found.front()), static_cast<double>(found.size()));
}

void release_grip(Instrument& instrument, EventLog& log) {
  if (instrument.held.empty()) return;
  const int object = static_cast<int>(instrument.held.front().point.object);
  instrument.held.clear();
  instrument.slipping = false;
  // The force of the previous step, because that of this step is not computed yet.
  log.add(TissueEventKind::release, {.instrument = instrument.slot, .object = object}, instrument.X_end.translation(),
          instrument.held_by);
}

void attach_grip_again(Instrument& instrument, std::span<DeformableObject> objects) {
  for (HeldPoint& held : instrument.held) attach_again(objects[held.point.object], held.point);
}

void add_grip(ConstraintSystem& system, Instrument& instrument, std::span<DeformableObject> objects,
              const Limits& limits) {
  for (HeldPoint& held : instrument.held) {
    const DeformableObject& object = objects[held.point.object];
    held.has_row = instrument.effective && object.calculates() && object.steps_now;
    if (!held.has_row) continue;
    const Vector3d anchor = instrument.X_start * held.p_T;
    ConstraintSystem::Hold hold;
    Vector3d correction = kCorrection / kStep_s * (anchor - position(object, held.point));
    const double speed = correction.norm();
    if (speed > kFastestCorrection) correction *= kFastestCorrection / speed;
    hold.velocity = instrument.velocity_at(anchor);
    if (hold.velocity.norm() > kFastestPush) hold.velocity *= kFastestPush / hold.velocity.norm();
    hold.velocity += correction;
    if (limits.clamps(TissueLimit::grip_force))
      hold.most = limits.value(TissueLimit::grip_force) * kStep_s / object.substeps;
    hold.softness = kGripSoftness;
    hold.impulse = held.impulse;
    add_terms(system, object, held.point, 1.0);
    held.row = system.add(hold);
  }
}

void take_grip(const ConstraintSystem& system, Instrument& instrument, std::span<const DeformableObject> objects) {
  const Vector3d tip = instrument.X_start.translation();
  for (HeldPoint& held : instrument.held) {
    if (!held.has_row) continue;
    const ConstraintSystem::Hold& hold = system.hold(held.row);
    held.impulse = hold.impulse;
    held.limited = held.limited || hold.limited;
    held.force = std::max(held.force, hold.impulse.norm() * objects[held.point.object].substeps / kStep_s);
    const Vector3d force = -hold.impulse / kStep_s;
    instrument.force += force;
    instrument.pull += force;
    instrument.torque += (instrument.X_start * held.p_T - tip).cross(force);
    instrument.directions += force.norm() / 3.0 * Eigen::Matrix3d::Identity();
  }
}

LimitActions finish_grip(Instrument& instrument, std::span<DeformableObject> objects, Limits& limits, EventLog& log) {
  LimitActions asked;
  instrument.held_by = instrument.pull.norm();
  if (instrument.held.empty()) return asked;
  bool slips = false;
  const Pose X_TW = instrument.X_end.inverse();
  Vector3d at = instrument.X_end.translation();
  const int object = static_cast<int>(instrument.held.front().point.object);
  for (HeldPoint& held : instrument.held) {
    const DeformableObject& body = objects[held.point.object];
    const Vector3d p = position(body, held.point);
    // A clamped force is just the limit.
    const double force = held.force * (held.limited ? 1.0 + 1e-9 : 1.0);
    asked.join(limits.examine(TissueLimit::grip_force, force, log,
                              {.instrument = instrument.slot, .object = static_cast<int>(held.point.object)}, p));
    if (held.limited) {
      held.p_T = X_TW * p;
      at = p;
      slips = true;
    }
    held.force = 0;
    held.limited = false;
  }
  if (slips && !instrument.slipping) {
    log.add(TissueEventKind::slip, {.instrument = instrument.slot, .object = object}, at, instrument.held_by);
  }
  if (slips) instrument.slipping = true;
  std::erase_if(instrument.held, [&](const HeldPoint& held) {
    return distance_from_axis(instrument, held.p_T) > instrument.shape.effector_radius_m + kLostBeyond;
  });
  if (instrument.held.empty()) {
    instrument.slipping = false;
    log.add(TissueEventKind::release, {.instrument = instrument.slot, .object = object}, at, instrument.held_by);
  }
  return asked;
}

}  // namespace cellmirror::tissue
