// What the owner of the cell publishes to the other threads: an immutable snapshot, replaced as a whole
// (Board<CellState>).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/snapshot/board.hpp"
#include "app/snapshot/contact_inlet.hpp"
#include "app/snapshot/controller_snapshot.hpp"
#include "app/snapshot/coupling_snapshot.hpp"
#include "app/snapshot/fault_target.hpp"
#include "app/snapshot/foot_switch_snapshot.hpp"
#include "app/snapshot/force_settings.hpp"
#include "app/snapshot/haptic_snapshot.hpp"
#include "app/snapshot/io_snapshot.hpp"
#include "app/snapshot/node_level.hpp"
#include "app/snapshot/program_snapshot.hpp"
#include "app/snapshot/robot_force_channel.hpp"
#include "app/snapshot/tcp_force_channel.hpp"
#include "app/snapshot/tissue_snapshot.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/volume_state.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::app {

struct RobotSnapshot {
  std::string id;
  std::size_t slot = 0;
  bool online = false;
  bool sending = false;
  std::shared_ptr<const JointStream> stream;  // null where it was never opened
  std::shared_ptr<ContactInlet> contacts;     // null: no drives that contacts act on
  std::shared_ptr<const FaultTarget> faults;  // null: no drives that answer a controller
  RobotParameters parameters;
  std::optional<JointValues> target;  // rad or m: where the newest commanded move ends
  Positioning positioning = Positioning::moving;
};

struct CellState {
  std::shared_ptr<const CompiledCell> cell;
  std::shared_ptr<const LevelList> levels;               // by node of `cell`
  std::shared_ptr<const collision::Settings> collision;  // the same object as long as nothing changes
  RangeSendMode range_send_mode = RangeSendMode::one_message_a_sensor;
  std::vector<RobotSnapshot> robots;  // in the order of the slots
  std::vector<HapticSnapshot> haptics;
  ForceSettings forces;
  std::shared_ptr<TcpForceChannel> tcp_force;    // null: not made yet
  std::vector<RobotForceSnapshot> robot_forces;  // plain buffers of rob_ela_shm
  std::string active_robot;
  std::string language;  // of robot programs that are loaded now
  script::ScriptCounters script;
  std::vector<script::RunStatus> runs;
  std::vector<std::string> script_errors;
  std::shared_ptr<const DisplayState> display;  // the same object as long as nothing changes
  ProgramsSnapshot programs;
  FootSwitchSnapshot switches;
  std::vector<CouplingSnapshot> couplings;
  std::vector<ControllerSnapshot> controllers;
  std::shared_ptr<const TissueSettings> tissue;  // the same object as long as nothing changes
  std::shared_ptr<const VolumeStates> volumes;   // the same object as long as nothing changes
  std::vector<IoNodeSnapshot> io_nodes;
};

}  // namespace cellmirror::app
