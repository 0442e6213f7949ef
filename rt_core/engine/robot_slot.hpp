// One robot inside the tick: its mode, its moves and its coupling. Its joint values belong to its gate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/engine/joint_gate.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/trajectory.hpp"
#include "rt_core/motion/trajectory_follower.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::engine {

// Tick thread only.
class RobotSlot {
 public:
  // Those that answer give false where the command does not fit the slot's mode, or the gate refused it.
  bool add(const RobotSetup& robot) CELL_RT;
  void remove() CELL_RT;
  void set_mode(const SetMode& command) CELL_RT;
  bool set_positions(const JointValues& positions) CELL_RT;
  void set_limits(const JointLimits& limits) CELL_RT { gate_.set_limits(limits); }
  bool set_chain(Lease<const kinematics::Chain> chain) CELL_RT;
  bool add_move(const motion::Move& move) CELL_RT;
  bool follow_trajectory(Lease<const motion::Trajectory> trajectory) CELL_RT;
  bool stop_motion() CELL_RT;
  bool set_pace(double pace) CELL_RT;
  bool hold_behind(std::uint32_t move) CELL_RT;
  // Takes over a sample of the stream: JointGate::take().
  void take(const JointSample& sample, Timestamp now) CELL_RT { gate_.take(sample, now); }
  // Moves a simulated robot on by `dt` seconds, to the instant `now`. True where it moved.
  bool move(double dt, Timestamp now) CELL_RT;
  // The joints that follow a master from now on. What moves is braked, or ends at once where joints become free. Joints
  // that follow are moved by follow() alone: moves and positions leave them as they are.
  void set_follow(std::uint8_t master, JointSet joints) CELL_RT;
  // Moves the coupled joints towards the master's. True where one moved.
  bool follow(const RobotTickState& master, const Coupling& coupling, double dt) CELL_RT;
  // Ages every joint by `now`.
  void update(Timestamp now) CELL_RT { gate_.age(now); }

  [[nodiscard]] const RobotTickState& state() const CELL_RT { return gate_.state(); }
  // Into a buffer that holds an older state.
  void publish(RobotTickState& out) const CELL_RT;
  [[nodiscard]] bool used() const CELL_RT { return state().mode != RobotMode::absent; }

  // For a recording of the tick (input_tap.hpp): a part of what is published, and all that the next ticks depend on.
  template <class Archive>
  void transfer_published(Archive& archive, std::size_t part) CELL_RT {
    gate_.transfer_published(archive, part);
  }
  void write(StateWriter& out) CELL_RT;
  // Of what follows trajectories; restore_trajectory() is its opposite.
  void write_trajectory(StateWriter& out) CELL_RT;
  // As it was written, in a slot that was not used yet; chains are lent again. What does not fit makes `in` fail. Not
  // for the tick.
  using LendChain = std::function<Lease<const kinematics::Chain>(const kinematics::Chain* chain)>;
  void restore(StateReader& in, const LendChain& lend);
  using LendTrajectory = std::function<Lease<const motion::Trajectory>(const motion::Trajectory* trajectory)>;
  void restore_trajectory(StateReader& in, const LendTrajectory& lend);
  // Whether it has ever followed one.
  [[nodiscard]] bool has_trajectory() const CELL_RT { return follower_.newest() != 0; }

 private:
  void retire(Lease<const kinematics::Chain> chain) CELL_RT;
  void give_back_chains() CELL_RT;
  // Towards the master's joint, or to rest where that is null.
  bool follow_joint(const JointTickState* master, std::size_t joint, const Coupling& coupling, double dt,
                    FollowTickState& follow) CELL_RT;
  [[nodiscard]] JointSet free_joints() const CELL_RT { return static_cast<JointSet>(~state().follow.joints); }
  [[nodiscard]] bool simulated() const CELL_RT { return state().mode == RobotMode::simulated; }

  JointGate gate_;
  motion::MoveExecutor executor_;
  motion::TrajectoryFollower follower_;  // moves the robot while it is active, else the executor does
  Lease<const motion::Trajectory> trajectory_;
  Lease<const kinematics::Chain> chain_;
  // Chains that were replaced while moves needed them: at most one of each move that runs or waits.
  std::array<Lease<const kinematics::Chain>, motion::kMoveQueue + 1> retired_chains_;
  std::size_t retired_ = 0;
};

}  // namespace cellmirror::engine
