// Makes the scene that is drawn from the cell, its posture and what is known about it: bodies as SCRIPT wants them
// drawn, frames, traces, near and touching pairs, cones of sensors, arrows of forces, pyramids of cameras, labels,
// legend.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/ports/tcp_trace.hpp"
#include "rt_core/ports/volume_state.hpp"

namespace cellmirror::scene {

// Of a robot, by its slot.
struct RobotCondition {
  std::size_t slot = 0;
  bool mirrored = false;
  DataState state = DataState::none;
  double age_s = 0;  // of the newest sample
};

// Null and empty: nothing is known. Everything outlives the call.
struct SceneInput {
  const CompiledCell* cell = nullptr;
  const CellPoses* poses = nullptr;  // of `cell`, at posture_time
  const DisplayState* display = nullptr;
  std::string_view active_robot;
  std::span<const RobotCondition> robots;
  const ProximityState* proximity = nullptr;
  std::span<const RangeReading> ranges;
  std::span<const BarrierReading> barriers;
  const ForceState* forces = nullptr;
  std::span<const ForceArrow> arrows;        // rt_core/dynamics/arrows.hpp
  std::span<const TcpTrace> traces;          // of SMEAR; drawn while the mode is on
  std::shared_ptr<const TissueView> tissue;  // shared with the scene
  const VolumeStates* volumes = nullptr;     // null: as their files have them
  Timestamp posture_time;
  Timestamp now;
};

// Keeps what does not change from one posture to the next. One thread; not real time.
class SceneBuilder {
 public:
  SceneBuilder();
  ~SceneBuilder();
  SceneBuilder(const SceneBuilder&) = delete;
  SceneBuilder& operator=(const SceneBuilder&) = delete;

  // Replaces all of `scene` (the same object again and again saves memory traffic). cell, poses and display are needed,
  // and the poses must be of this cell.
  void build(const SceneInput& input, Scene& scene);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::scene
