#include "rt_core/tissue/effects/vessels.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kSampleSpacing = 0.002;  // m
constexpr double kSealingBurn = 0.8;      // an end burnt so much is closed
constexpr double kArteryFlow = 60.0;      // ml/min, of a vessel of 2 mm radius; goes with the cross-section
constexpr double kVeinFlow = 20.0;
constexpr double kBackFlow = 4.0;  // from the far end, while what is in it runs out
constexpr double kBackFlowTime_s = 4.0;
constexpr double kReferenceRadius = 0.002;  // m
constexpr double kTornStretch = 4.0;        // of a segment's length at rest

// A unit vector at right angles to d.
Vector3d any_normal(const Vector3d& d) {
  Eigen::Index least = 0;
  (void)d.cwiseAbs().minCoeff(&least);
  return d.cross(Vector3d::Unit(least)).normalized();
}

// The centre line at equal distances, with their arc lengths.
std::vector<std::pair<Vector3d, double>> resample(const std::vector<Vector3d>& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  const auto wanted = static_cast<std::size_t>(std::ceil(length / kSampleSpacing));
  const std::size_t pieces = std::clamp<std::size_t>(wanted, 1, Vessels::kMostSamples - 1);
  std::vector<std::pair<Vector3d, double>> out;
  std::size_t at = 1;
  double before = 0;  // arc length of line[at - 1]
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double arc = length * static_cast<double>(i) / static_cast<double>(pieces);
    double piece = (line[at] - line[at - 1]).norm();
    while (at + 1 < line.size() && before + piece < arc) {
      before += piece;
      ++at;
      piece = (line[at] - line[at - 1]).norm();
    }
    const double share = piece > 0 ? std::clamp((arc - before) / piece, 0.0, 1.0) : 0.0;
    out.emplace_back(line[at - 1] + share * (line[at] - line[at - 1]), arc);
  }
  return out;
}

}  // namespace

// A systole of a third of the period, rising and falling as a squared sine.
double pulse_wave(double time_s) {
  constexpr double kSystole = 0.35;
  double phase = std::fmod(time_s / kPulsePeriod_s, 1.0);
  if (phase < 0) phase += 1.0;
  if (phase >= kSystole) return 0;
  const double s = std::sin(std::numbers::pi * phase / kSystole);
  return s * s;
}

std::optional<double> crossing(const BladeSweep& blade, const Vector3d& a, const Vector3d& b) {
  const Vector3d normal = blade.along.cross(blade.across);
  const double area = normal.squaredNorm();
  const double from = normal.dot(a - blade.corner);
  const double to = normal.dot(b - blade.corner);
  if (!(area > 0) || (from > 0) == (to > 0) || from == to) return std::nullopt;
  const double share = from / (from - to);
  const Vector3d r = a + share * (b - a) - blade.corner;
  const double u = r.cross(blade.across).dot(normal) / area;
  const double v = blade.along.cross(r).dot(normal) / area;
  if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return std::nullopt;
  return share;
}

void Vessels::add_object(const DeformableObject& object, std::uint32_t number) {
  if (!object.body) return;
  for (const Vessel& vessel : object.description.vessels) {
    if (tracks_.size() >= kMostVessels || vessel.centre_line.size() < 2) continue;
    Track track;
    track.description = vessel;
    track.object = number;
    std::vector<Vector3d> line;
    for (const Vector3d& p : vessel.centre_line) line.push_back(object.description.X_WO * p);
    const auto places = resample(line);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector3d& p = places[i].first;
      const Vector3d way = places[std::min(i + 1, places.size() - 1)].first - places[i > 0 ? i - 1 : 0].first;
      const Vector3d u = way.norm() > 0 ? any_normal(way.normalized()) : Vector3d::UnitX();
      const Vector3d v = way.norm() > 0 ? Vector3d(way.normalized().cross(u)) : Vector3d::UnitY();
      VesselSample sample;
      sample.arc_m = places[i].second;
      sample.centre = object.body->embed_at_rest(p);
      const double r = vessel.radius_m;
      sample.around = {object.body->embed_at_rest(p + r * u), object.body->embed_at_rest(p - r * u),
                       object.body->embed_at_rest(p + r * v), object.body->embed_at_rest(p - r * v)};
      track.samples.push_back(sample);
    }
    tracks_.push_back(std::move(track));
  }
}

void Vessels::reset() {
  sources_.clear();
  time_s_ = 0;
  for (Track& track : tracks_) {
    track.cuts.clear();
    track.clips.clear();
    track.bleeding_ml_min = 0;
    track.reported_bleeding = false;
  }
}

void Vessels::follow_cuts(std::span<const DeformableObject> objects) {
  for (Track& track : tracks_) {
    const Body& body = *objects[track.object].body;
    for (VesselSample& sample : track.samples) {
      body.follow_cuts(sample.centre);
      for (EmbeddedPoint& point : sample.around) body.follow_cuts(point);
    }
  }
}

bool Vessels::clipped_between(const Track& track, double from_m, double to_m) {
  return std::ranges::any_of(track.clips, [&](double arc) { return arc >= from_m && arc <= to_m; });
}

void Vessels::add_pulse(std::span<DeformableObject> objects, std::uint32_t object, double time_s) const {
  for (const Track& track : tracks_) {
    if (track.object != object || track.description.kind != VesselKind::artery) continue;
    double end = std::numeric_limits<double>::infinity();  // behind a clip or a cut there is no wave
    for (const double clip : track.clips) end = std::min(end, clip);
    for (const Cut& cut : track.cuts) end = std::min(end, track.samples[cut.segment].arc_m);
    Body& body = *objects[object].body;
    // The wall's area of a sample, a quarter for each direction.
    const double area = 0.5 * std::numbers::pi * track.description.radius_m * kSampleSpacing;
    for (const VesselSample& sample : track.samples) {
      if (sample.arc_m > end) break;
      const double force = kPulsePressure * area * pulse_wave(time_s - sample.arc_m / kPulseWaveSpeed);
      if (force == 0) continue;
      for (std::size_t i = 0; i < 4; i += 2) {
        const Vector3d way = body.position(sample.around[i]) - body.position(sample.around[i + 1]);
        const double length = way.norm();
        if (!(length > 1e-9)) continue;
        body.add_force(sample.around[i], force / length * way);
        body.add_force(sample.around[i + 1], -force / length * way);
      }
    }
  }
}

void Vessels::sever(Track& track, std::uint32_t segment, const Vector3d& at, int instrument, EventLog& log) const {
  const bool known = std::ranges::any_of(track.cuts, [&](const Cut& cut) { return cut.segment == segment; });
  if (known || track.cuts.size() >= kMostCuts) return;
  track.cuts.push_back({segment, time_s_});
  std::ranges::sort(track.cuts, {}, &Cut::segment);
  log.add(instrument >= 0 ? TissueEventKind::cut : TissueEventKind::tear,
          {.instrument = instrument, .object = static_cast<int>(track.object), .part = track.description.name}, at,
          std::numbers::pi * track.description.radius_m * track.description.radius_m);
}

void Vessels::sever(std::span<const DeformableObject> objects, std::uint32_t object, const BladeSweep& blade,
                    int instrument, EventLog& log) {
  const Body& body = *objects[object].body;
  for (Track& track : tracks_) {
    if (track.object != object) continue;
    Vector3d a = body.position(track.samples.front().centre);
    for (std::uint32_t i = 0; i + 1 < track.samples.size(); ++i) {
      const Vector3d b = body.position(track.samples[i + 1].centre);
      const auto share = crossing(blade, a, b);
      const bool burnt = blade.min_burn <= 0 || std::min(body.burn(track.samples[i].centre),
                                                         body.burn(track.samples[i + 1].centre)) >= blade.min_burn;
      if (share && burnt) sever(track, i, a + *share * (b - a), instrument, log);
      a = b;
    }
  }
}

void Vessels::sever_stretched(std::span<const DeformableObject> objects, EventLog& log) {
  for (Track& track : tracks_) {
    const DeformableObject& object = objects[track.object];
    for (std::uint32_t i = 0; i + 1 < track.samples.size(); ++i) {
      // The tissue may be cut a sample or two beside the centre line: its two ends are no new tear.
      const auto beside = [&](const Cut& cut) { return std::max(cut.segment, i) - std::min(cut.segment, i) <= 2; };
      if (std::ranges::any_of(track.cuts, beside)) continue;
      const Vector3d a = object.body->position(track.samples[i].centre);
      const Vector3d b = object.body->position(track.samples[i + 1].centre);
      const double rest = track.samples[i + 1].arc_m - track.samples[i].arc_m;
      if ((b - a).norm() > kTornStretch * rest + kSampleSpacing) sever(track, i, 0.5 * (a + b), -1, log);
    }
  }
}

std::optional<Vessels::Place> Vessels::nearest(std::span<const DeformableObject> objects, TissueAttribute needed,
                                               const Vector3d& p, double reach) const {
  std::optional<Place> best;
  for (std::uint32_t number = 0; number < tracks_.size(); ++number) {
    const Track& track = tracks_[number];
    const DeformableObject& object = objects[track.object];
    if (!object.has(needed)) continue;
    for (std::uint32_t i = 0; i < track.samples.size(); ++i) {
      const double distance = (object.body->position(track.samples[i].centre) - p).norm();
      if (distance > reach + track.description.radius_m || (best && distance >= best->distance)) continue;
      best = Place{.vessel = number, .sample = i, .arc_m = track.samples[i].arc_m, .distance = distance};
    }
  }
  return best;
}

void Vessels::close(const Place& place) {
  std::vector<double>& clips = tracks_[place.vessel].clips;
  if (clips.size() < kMostClips) clips.push_back(place.arc_m);
}

void Vessels::bleed(const DeformableObject& object, std::uint32_t number, double time_s, bool pulse) {
  Track& track = tracks_[number];
  const Body& body = *object.body;
  const VesselKind kind = track.description.kind;
  if (kind == VesselKind::duct) return;
  const double ratio = track.description.radius_m / kReferenceRadius;
  const double section = std::min(ratio * ratio, 10.0);
  bool fed = true;  // a cut upstream takes all that comes
  for (std::size_t i = 0; i < track.cuts.size(); ++i) {
    const Cut& cut = track.cuts[i];
    const VesselSample& up = track.samples[cut.segment];
    const VesselSample& down = track.samples[cut.segment + 1];
    const Vector3d p_up = body.position(up.centre);
    const Vector3d p_down = body.position(down.centre);
    if (fed && !clipped_between(track, 0, up.arc_m) && body.burn(up.centre) <= kSealingBurn) {
      const VesselSample& before = track.samples[cut.segment > 0 ? cut.segment - 1 : 0];
      const Vector3d way = cut.segment > 0 ? Vector3d(p_up - body.position(before.centre)) : Vector3d(p_down - p_up);
      const bool artery = kind == VesselKind::artery;
      const double beat = artery && pulse ? 0.4 + 1.2 * pulse_wave(time_s - up.arc_m / kPulseWaveSpeed) : 1.0;
      sources_.push_back({number, p_up, way.norm() > 0 ? Vector3d(way.normalized()) : Vector3d::UnitZ(),
                          section * beat * (artery ? kArteryFlow : kVeinFlow), artery});
    }
    fed = false;
    const double next_end = i + 1 < track.cuts.size() ? track.samples[track.cuts[i + 1].segment].arc_m
                                                      : std::numeric_limits<double>::infinity();
    if (time_s - cut.since_s < kBackFlowTime_s && !clipped_between(track, down.arc_m, next_end) &&
        body.burn(down.centre) <= kSealingBurn) {
      const double left = 1.0 - (time_s - cut.since_s) / kBackFlowTime_s;
      const Vector3d way = p_up - p_down;
      sources_.push_back({number, p_down, way.norm() > 0 ? Vector3d(way.normalized()) : Vector3d::UnitZ(),
                          section * left * kBackFlow, false});
    }
  }
}

void Vessels::bleed(std::span<const DeformableObject> objects, double time_s, bool pulse, bool bleeding,
                    EventLog& log) {
  time_s_ = time_s;
  sources_.clear();
  for (std::uint32_t number = 0; number < tracks_.size(); ++number) {
    Track& track = tracks_[number];
    const std::size_t first = sources_.size();
    if (bleeding && !track.cuts.empty()) bleed(objects[track.object], number, time_s, pulse);
    track.bleeding_ml_min = 0;
    for (std::size_t i = first; i < sources_.size(); ++i) track.bleeding_ml_min += sources_[i].ml_min;
    const bool bleeds = track.bleeding_ml_min > 0;
    if (bleeds == track.reported_bleeding) continue;
    track.reported_bleeding = bleeds;
    const Vector3d at = bleeds ? sources_[first].at
                        : track.cuts.empty()
                            ? Vector3d(Vector3d::Zero())
                            : objects[track.object].body->position(track.samples[track.cuts.front().segment].centre);
    log.add(bleeds ? TissueEventKind::bleed : TissueEventKind::bleed_end,
            {.object = static_cast<int>(track.object), .part = track.description.name}, at, track.bleeding_ml_min);
  }
}

void Vessels::describe(std::span<const DeformableObject> objects, std::vector<TissueVesselState>& states) const {
  states.clear();
  for (const Track& track : tracks_) {
    TissueVesselState state;
    state.object = objects[track.object].description.name;
    state.name = track.description.name;
    state.kind = static_cast<std::uint8_t>(track.description.kind);
    state.severed = !track.cuts.empty();
    state.clips = static_cast<std::uint32_t>(track.clips.size());
    state.bleeding_ml_min = track.bleeding_ml_min;
    states.push_back(std::move(state));
  }
}

}  // namespace cellmirror::tissue
