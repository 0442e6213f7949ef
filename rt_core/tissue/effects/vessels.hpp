// Vessels in deformable objects: centre lines embedded in the tissue, where they are cut, closed or bleed, and the
// pressure wave that widens them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rt_core/tissue/contact/surface_point.hpp"
#include "rt_core/tissue/description/event_log.hpp"

namespace cellmirror::tissue {

inline constexpr double kPulsePeriod_s = 0.85;
inline constexpr double kPulseWaveSpeed = 5.0;   // m/s
inline constexpr double kPulsePressure = 800.0;  // Pa, on the surrounding tissue: the wall carries the rest

// Share of the systolic pressure, 0 to 1, at a time since the heart's beat.
[[nodiscard]] double pulse_wave(double time_s);

struct VesselSample {
  EmbeddedPoint centre;
  // Around the centre at right angles to the line; 0 is opposite of 1, and 2 of 3.
  std::array<EmbeddedPoint, 4> around;
  double arc_m = 0;  // from the first point of the centre line, at rest
};

class Vessels {
 public:
  static constexpr std::size_t kMostVessels = 64;
  static constexpr std::size_t kMostSamples = 512;  // of a vessel
  static constexpr std::size_t kMostCuts = 16;      // of a vessel
  static constexpr std::size_t kMostClips = 16;

  struct Place {
    std::uint32_t vessel = 0;
    std::uint32_t sample = 0;  // the nearest one
    double arc_m = 0;
    double distance = 0;  // m, between the centre line and the point
  };
  // Where blood leaves, and how much.
  struct Source {
    std::uint32_t vessel = 0;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double ml_min = 0;
    bool jet = false;  // from an artery's upstream end
  };

  void add_object(const DeformableObject& object, std::uint32_t number);
  void reset();
  // After a cut or a reset of an object: points stay with their material.
  void follow_cuts(std::span<const DeformableObject> objects);

  // Forces of the pressure wave for the next begin_step() of the object.
  void add_pulse(std::span<DeformableObject> objects, std::uint32_t object, double time_s) const;
  // A blade went through an object: vessels that it crosses are severed where they are burnt at least `min_burn`.
  void sever(std::span<const DeformableObject> objects, std::uint32_t object, const BladeSweep& blade, int instrument,
             EventLog& log);
  // Vessels that are stretched so far that the tissue about them must have torn.
  void sever_stretched(std::span<const DeformableObject> objects, EventLog& log);
  [[nodiscard]] std::optional<Place> nearest(std::span<const DeformableObject> objects, TissueAttribute needed,
                                             const Eigen::Vector3d& p, double reach) const;
  void close(const Place& place);

  // Flow from all open ends; reports where a vessel begins and ends to bleed. Once a step.
  void bleed(std::span<const DeformableObject> objects, double time_s, bool pulse, bool bleeding, EventLog& log);
  [[nodiscard]] std::span<const Source> sources() const { return sources_; }

  [[nodiscard]] const Vessel& description(std::uint32_t vessel) const { return tracks_[vessel].description; }
  [[nodiscard]] std::uint32_t object_of(std::uint32_t vessel) const { return tracks_[vessel].object; }
  [[nodiscard]] const VesselSample& sample(std::uint32_t vessel, std::uint32_t sample) const {
    return tracks_[vessel].samples[sample];
  }
  [[nodiscard]] bool empty() const { return tracks_.empty(); }
  void describe(std::span<const DeformableObject> objects, std::vector<TissueVesselState>& states) const;

 private:
  struct Cut {
    std::uint32_t segment = 0;  // between this sample and the next one
    double since_s = 0;
  };
  struct Track {
    Vessel description;
    std::uint32_t object = 0;
    std::vector<VesselSample> samples;
    std::vector<Cut> cuts;
    std::vector<double> clips;  // arc lengths
    double bleeding_ml_min = 0;
    bool reported_bleeding = false;
  };

  void sever(Track& track, std::uint32_t segment, const Eigen::Vector3d& at, int instrument, EventLog& log) const;
  void bleed(const DeformableObject& object, std::uint32_t number, double time_s, bool pulse);
  [[nodiscard]] static bool clipped_between(const Track& track, double from_m, double to_m);

  std::vector<Track> tracks_;
  std::vector<Source> sources_;
  double time_s_ = 0;
};

// Where the segment from a to b goes through a blade's parallelogram, as a share of the way; none if it does not.
[[nodiscard]] std::optional<double> crossing(const BladeSweep& blade, const Eigen::Vector3d& a,
                                             const Eigen::Vector3d& b);

}  // namespace cellmirror::tissue
