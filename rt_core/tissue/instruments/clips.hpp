// Clips that were placed: they follow the tissue about them and, on a vessel, keep its sides together.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/tissue/contact/constraint_system.hpp"
#include "rt_core/tissue/description/event_log.hpp"
#include "rt_core/tissue/effects/vessels.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"
#include "rt_core/tissue/instruments/instrument_contacts.hpp"

namespace cellmirror::tissue {

class Clips {
 public:
  static constexpr std::size_t kMostClips = 64;

  void reset();
  // Where the condition has become true: on the nearest vessel within reach, else on the nearest surface. False: there
  // is nothing within reach that takes a clip.
  bool place(const Instrument& instrument, std::span<DeformableObject> objects, Vessels& vessels,
             InstrumentContacts& finder, EventLog& log);
  void add(ConstraintSystem& system, std::span<DeformableObject> objects, double dt);
  void take(const ConstraintSystem& system);
  // After a cut or a reset of an object: points stay with their material.
  void follow_cuts(std::span<const DeformableObject> objects);
  void forget_impulses();
  void view(std::span<const DeformableObject> objects, std::vector<TissueClip>& clips) const;
  [[nodiscard]] std::size_t count() const { return clips_.size(); }

 private:
  struct Clip {
    std::uint32_t object = 0;
    std::array<EmbeddedPoint, 3> frame;  // of the tissue: origin, and where its x axis and its plane go through
    Pose X_FC = Pose::Identity();
    bool closes_vessel = false;
    std::array<EmbeddedPoint, 2> sides;  // of the vessel
    double closed_m = 0;                 // distance of the sides when it is closed
    double impulse = 0;
    bool has_row = false;
    std::size_t row = 0;
    std::shared_ptr<const std::vector<Eigen::Vector3f>> vertices;
    std::shared_ptr<const std::vector<std::array<std::uint32_t, 3>>> triangles;
  };

  [[nodiscard]] static Pose frame(const Body& body, const std::array<EmbeddedPoint, 3>& points);

  std::vector<Clip> clips_;
};

}  // namespace cellmirror::tissue
