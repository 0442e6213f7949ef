// Where events and shapes of deformable objects go: outputs that programs outside of the gateway read. SI, world frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror {

// An event with the names of its numbers.
struct NamedTissueEvent {
  TissueEvent event;
  std::string robot;   // that holds the instrument; empty: none
  std::string object;  // empty: none
};

// Receives events outside the tick. One calling thread (the publisher). Never blocks for long; what cannot be delivered
// is dropped and counted by the implementation.
class TissueEventOutput {
 public:
  virtual ~TissueEventOutput() = default;
  // `events`: oldest first, none of them twice; a gap in their numbers is events that nobody could give to this output.
  virtual void publish_tissue_events(std::span<const NamedTissueEvent> events) = 0;
};

// The force of the tissue on an instrument.
struct TissueForceArrow {
  std::string robot;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();       // the tool centre point
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();  // N
};

// Receives shapes outside the tick, at a rate of its own. One calling thread (the publisher).
class TissueShapeOutput {
 public:
  virtual ~TissueShapeOutput() = default;
  // How often it wants them; 0: never.
  [[nodiscard]] virtual Nanoseconds tissue_period() const = 0;
  // `time`: of the posture that they were computed for.
  virtual void publish_tissue_shapes(Timestamp time, const TissueView& view,
                                     std::span<const TissueForceArrow> forces) = 0;
};

}  // namespace cellmirror
