// Drives the simulation of tissue from what the tick and the owner publish: where the instruments and the rigid bodies
// are. Shared by the worker of the running gateway and the off-line simulation. One thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/snapshot/cell_poser.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/workers/pose_ramp.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/geometry/solid.hpp"
#include "rt_core/tissue/world.hpp"

namespace cellmirror::app {

class TissueStepper {
 public:
  // `solids` is shared with the other workers.
  TissueStepper(tissue::World world, std::shared_ptr<geometry::SolidLibrary> solids);

  // One step of a millisecond at the tick's posture. False, and nothing computed, where the tick does not know all
  // robots of the cell yet.
  bool step(const CellState& cell_state, const engine::TickState& tick);

  [[nodiscard]] tissue::World& world() { return world_; }
  [[nodiscard]] const tissue::World& world() const { return world_; }
  // Poses of the instruments in the last step.
  [[nodiscard]] std::span<const tissue::InstrumentPose> instruments() const { return instruments_; }

 private:
  // A rigid body, and whether a joint can move it.
  struct Obstacle {
    std::int32_t node = 0;
    std::shared_ptr<const geometry::Solid> solid;
    Pose X_NG = Pose::Identity();
  };

  void follow(const CellState& cell_state);
  void collect_instruments(const CellState& cell_state);
  void collect_obstacles();
  void pose_instruments(const engine::TickState& tick);
  void pose_obstacles();

  tissue::World world_;
  std::shared_ptr<geometry::SolidLibrary> solids_;
  CellPoser poser_{false, true};
  std::shared_ptr<const TissueSettings> settings_;
  std::vector<std::uint8_t> slots_;  // of the instruments' robots
  std::vector<JointValues> joints_;  // by instrument
  std::vector<PoseRamp> ramps_;      // by instrument
  std::vector<Obstacle> obstacles_;
  std::vector<tissue::InstrumentPose> instruments_;
  std::vector<tissue::RigidBodyPose> bodies_;
};

}  // namespace cellmirror::app
