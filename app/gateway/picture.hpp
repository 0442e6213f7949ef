// What the owner of the cell lets the other threads see: an immutable picture, replaced as a whole.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/gateway/coupling_desk.hpp"
#include "app/gateway/force_settings.hpp"
#include "app/gateway/haptic_desk.hpp"
#include "app/gateway/hosts.hpp"
#include "app/gateway/node_levels.hpp"
#include "app/gateway/program_picture.hpp"
#include "app/gateway/switch_desk.hpp"
#include "app/gateway/tcp_force_memory.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::app {

struct RobotPicture {
  std::string id;
  std::size_t slot = 0;
  bool online = false;
  bool sending = false;
  std::shared_ptr<const JointStream> stream;  // null where it was never opened
  RobotParameters parameters;
  std::optional<JointValues> target;  // rad or m: where the newest commanded move ends
  Positioning positioning = Positioning::moving;
};

struct OwnerPicture {
  std::shared_ptr<const CompiledCell> cell;
  std::shared_ptr<const LevelList> levels;               // by node of `cell`
  std::shared_ptr<const collision::Settings> collision;  // the same object as long as nothing changes
  RangeSendMode range_send_mode = RangeSendMode::one_message_a_sensor;
  std::vector<RobotPicture> robots;  // in the order of the slots
  std::vector<HapticPicture> haptics;
  ForceSettings forces;
  std::shared_ptr<TcpForceMemory> tcp_force;  // null: not made yet
  std::string active_robot;
  std::string language;  // of robot programs that are loaded now
  script::ScriptCounters script;
  std::vector<script::RunStatus> runs;
  std::vector<std::string> script_errors;
  std::shared_ptr<const DisplayState> display;  // the same object as long as nothing changes
  ProgramsPicture programs;
  SwitchPicture switches;
  std::vector<CouplingPicture> couplings;
};

// Between workers only; the tick has no part in it, so a lock is allowed.
class PictureBoard {
 public:
  void hang_up(std::shared_ptr<const OwnerPicture> picture) {
    const std::scoped_lock lock(mutex_);
    picture_ = std::move(picture);
  }
  // Never null after the first one was hung up.
  [[nodiscard]] std::shared_ptr<const OwnerPicture> look() const {
    const std::scoped_lock lock(mutex_);
    return picture_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const OwnerPicture> picture_;
};

}  // namespace cellmirror::app
