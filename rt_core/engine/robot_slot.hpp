// One robot inside the tick: its mode, its newest joint values and how old they are.
#pragma once

#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::engine {

// Tick thread only.
class RobotSlot {
 public:
  // False where the command does not fit the slot's mode or the limiter refused it.
  bool apply(const Command& command) CELL_RT;
  // Takes over a sample of the stream. Values that are not finite are refused joint by joint; the joint keeps its last
  // good value and becomes invalid.
  void take(const JointSample& sample) CELL_RT;
  bool add_move(const motion::Move& move) CELL_RT;
  // Moves a simulated robot on by `dt` seconds, to the instant `now`. True where it moved.
  bool move(double dt, Timestamp now) CELL_RT;
  // The joints (bits) that follow a master from now on; 0: none. What moves is braked, or ends
  // at once where joints become free. Joints that follow are moved by
  // follow() alone: moves and positions leave them as they are.
  void set_follow(std::uint8_t master, std::uint16_t joints) CELL_RT;
  // Moves the coupled joints towards the master's. True where one moved.
  bool follow(const RobotTickState& master, const Coupling& coupling, double dt) CELL_RT;
  // Ages every joint by `now`.
  void update(Timestamp now) CELL_RT;

  [[nodiscard]] const RobotTickState& state() const CELL_RT { return state_; }
  // Into a buffer that holds an older state.
  void publish(RobotTickState& out) const CELL_RT;
  [[nodiscard]] bool used() const CELL_RT { return state_.mode != RobotMode::absent; }

 private:
  bool set_positions(const Command& command) CELL_RT;
  void add(const Command& command) CELL_RT;
  void set_mode(const Command& command) CELL_RT;
  bool set_chain(const kinematics::Chain* chain) CELL_RT;
  bool follow_joint(const JointTickState& master, std::size_t joint, double max_step, double dt) CELL_RT;
  [[nodiscard]] bool follows(std::size_t joint) const CELL_RT { return ((state_.follow.joints >> joint) & 1U) != 0; }
  [[nodiscard]] bool gives(std::size_t joint) const CELL_RT { return ((given_ >> joint) & 1U) != 0; }
  [[nodiscard]] bool simulated() const CELL_RT { return state_.mode == RobotMode::simulated; }

  RobotTickState state_;
  StreamAges ages_;
  std::uint16_t given_ = 0xFFFF;  // joints (bits) whose position the stream gives; never 0
  JointValues lower_{};
  JointValues upper_{};
  motion::MoveExecutor executor_;
};

}  // namespace cellmirror::engine
