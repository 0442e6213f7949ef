#include "rt_core/tissue/instruments/tools.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kHeatSteps = 8;   // heat is applied, and a hook cuts, each so many steps
constexpr double kSmokeRate = 0.25;       // 1/s, while tissue is heated
constexpr std::uint64_t kPuffSteps = 40;  // between two puffs of smoke
constexpr double kSuction = 30e-6;        // m3/s
constexpr double kSuctionReach = 0.005;   // m above the level at which it still draws
constexpr double kSuctionSmoke = 1.0;     // 1/s
constexpr double kSuctionRadius = 0.008;  // m
constexpr double kIrrigation = 10e-6;     // m3/s
constexpr double kIrrigationSpeed = 0.8;  // m/s

bool near(const DeformableObject& object, const BladeSweep& blade) {
  Vector3d low = blade.corner;
  Vector3d high = blade.corner;
  for (const Vector3d& p : {Vector3d(blade.corner + blade.along), Vector3d(blade.corner + blade.across),
                            Vector3d(blade.corner + blade.along + blade.across)}) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // The surface's box is that of the step's start.
  const Vector3d slack = Vector3d::Constant(0.002);
  return ((low - slack).array() <= object.surface.high().array()).all() &&
         ((high + slack).array() >= object.surface.low().array()).all();
}

void sweep(Instrument& instrument, const BladeSweep& blade, ToolSite& site) {
  for (std::uint32_t number = 0; number < site.objects.size(); ++number) {
    DeformableObject& object = site.objects[number];
    if (!object.has(TissueAttribute::cut) || !object.calculates() || !near(object, blade)) continue;
    site.vessels.sever(site.objects, number, blade, instrument.slot, site.log);
    const CutResult result = object.body->cut(blade);
    if (result.links == 0) continue;
    instrument.stroke_area_m2 += result.area_m2;
    instrument.stroke_at = result.at;
    instrument.stroke_object = static_cast<int>(number);
  }
}

// One event for all that was cut since the last one.
void report_stroke(Instrument& instrument, EventLog& log) {
  if (instrument.stroke_area_m2 > 0) {
    log.add(TissueEventKind::cut, {.instrument = instrument.slot, .object = instrument.stroke_object},
            instrument.stroke_at, instrument.stroke_area_m2);
  }
  instrument.stroke_area_m2 = 0;
}

// The blades' crossing moves from the pivot to the tips; what it passes is divided.
void close_scissors(Instrument& instrument, ToolSite& site) {
  const double length = instrument.shape.effector_length_m;
  if (!instrument.acting) {
    report_stroke(instrument, site.log);
    instrument.cut_front_m = 0;
    return;
  }
  if (instrument.cut_front_m >= length) return;
  const double before = instrument.cut_front_m;
  instrument.cut_front_m = std::min(length, before + kCutSpeed * kStep_s);
  const double half = instrument.shape.effector_radius_m;
  const Vector3d from = instrument.X_start * Vector3d(0, -half, before - length);
  const Vector3d to = instrument.X_end * Vector3d(0, -half, instrument.cut_front_m - length);
  sweep(instrument, {.corner = from, .along = to - from, .across = 2 * half * instrument.X_end.linear().col(1)}, site);
  if (instrument.cut_front_m >= length) report_stroke(instrument, site.log);
}

Capsule heated_zone(const Instrument& instrument) {
  return {instrument.X_end * Vector3d(0, 0, -instrument.shape.effector_length_m), instrument.X_end.translation(),
          instrument.shape.effector_radius_m};
}

void heat(Instrument& instrument, double dose_1_s, ToolSite& site) {
  const Capsule zone = heated_zone(instrument);
  const double dose = dose_1_s * static_cast<double>(kHeatSteps) * kStep_s;
  for (std::uint32_t number = 0; number < site.objects.size(); ++number) {
    DeformableObject& object = site.objects[number];
    if (!object.has(TissueAttribute::coagulate)) continue;
    // Heat spreads by conduction; nodes are an element apart.
    const double radius = std::max(2.0 * zone.radius, 1.2 * object.description.element_size_m);
    const Vector3d wide = Vector3d::Constant(radius);
    if (((zone.a.cwiseMin(zone.b) - wide).array() > object.surface.high().array()).any() ||
        ((zone.a.cwiseMax(zone.b) + wide).array() < object.surface.low().array()).any()) {
      continue;
    }
    site.found.clear();
    object.surface.near_segment(zone.a, zone.b, zone.radius + 0.003, site.found);
    if (site.found.empty()) continue;
    const double volume = object.body->heat(zone.a, zone.b, radius, dose);
    if (!(volume > 0)) continue;
    instrument.heated_m3 += volume;
    instrument.stroke_object = static_cast<int>(number);
    site.surroundings.smoke =
        std::min(1.0, site.surroundings.smoke + kSmokeRate * static_cast<double>(kHeatSteps) * kStep_s);
    if (!instrument.heating) {
      instrument.heating = true;
      site.log.add(TissueEventKind::coagulate, {.instrument = instrument.slot, .object = static_cast<int>(number)},
                   zone.b, 0.0);
    }
    if (site.step % kPuffSteps < kHeatSteps) site.particles.smoke(zone.b);
  }
}

void end_heating(Instrument& instrument, ToolSite& site) {
  report_stroke(instrument, site.log);
  instrument.swept = false;
  if (instrument.heating) {
    const DeformableObject& object = site.objects[static_cast<std::size_t>(instrument.stroke_object)];
    site.log.add(TissueEventKind::coagulate, {.instrument = instrument.slot, .object = instrument.stroke_object},
                 instrument.X_end.translation(), instrument.heated_m3 / std::max(object.body->volume_at_rest(), 1e-12));
  }
  instrument.heating = false;
  instrument.heated_m3 = 0;
}

// What the hook has passed since it last cut.
void cut_with_hook(Instrument& instrument, ToolSite& site) {
  const Capsule zone = heated_zone(instrument);
  if (instrument.swept) {
    const Vector3d way = zone.a - instrument.swept_from;
    sweep(instrument, {.corner = instrument.swept_from, .along = way, .across = zone.b - zone.a, .min_burn = kCutBurn},
          site);
  }
  instrument.swept = true;
  instrument.swept_from = zone.a;
}

}  // namespace

void use_tool(Instrument& instrument, ToolSite& site) {
  const bool works = instrument.effective;
  switch (instrument.action.kind) {
    case InstrumentKind::gripper:
      break;
    case InstrumentKind::clip_applicator:
      // One closing sets one clip, where the jaws close.
      if (works && instrument.started()) {
        site.clips.place(instrument, site.objects, site.vessels, site.finder, site.log);
      }
      break;
    case InstrumentKind::scissors:
      if (works || !instrument.acting) close_scissors(instrument, site);
      break;
    case InstrumentKind::hook:
    case InstrumentKind::forceps:
      if (!instrument.acting) {
        if (instrument.acted) end_heating(instrument, site);
      } else if (works && site.step % kHeatSteps == 0) {
        const bool hook = instrument.action.kind == InstrumentKind::hook;
        heat(instrument, hook ? kHookDose : kForcepsDose, site);
        if (hook) cut_with_hook(instrument, site);
      }
      break;
  }
}

void use_fluids(const Instrument& instrument, ToolSite& site) {
  const Vector3d tip = instrument.X_end.translation();
  Surroundings& around = site.surroundings;
  const bool ripples = around.on(TissueEffect::pool_ripples);
  double depth = 0;
  const bool over = site.pool.over(tip, depth);
  if (around.on(TissueEffect::suction) && around.suction == instrument.slot) {
    around.smoke = std::max(0.0, around.smoke - kSuctionSmoke * kStep_s);
    site.particles.remove_near(tip, kSuctionRadius);
    if (over && depth > -kSuctionReach) {
      site.pool.remove(kSuction * kStep_s);
      if (ripples && site.step % 16 == 0) site.pool.disturb(tip, -0.02, kSuctionRadius);
    }
  }
  if (around.on(TissueEffect::irrigation) && around.irrigation == instrument.slot) {
    site.particles.pour(ParticleKind::water, kIrrigation * kStep_s, tip,
                        kIrrigationSpeed * instrument.X_end.linear().col(2), site.pool);
  }
  if (ripples && over && depth > 0 && site.step % 4 == 0 && instrument.effective) {
    const double speed = std::min(instrument.speed.norm(), 0.5);
    if (speed > 0.002) site.pool.disturb(tip, -0.1 * speed, instrument.shape.effector_radius_m);
  }
}

}  // namespace cellmirror::tissue
