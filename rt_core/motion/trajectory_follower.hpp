// Follows the trajectory of one robot, tick by tick. Belongs to the tick thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/motion/ptp.hpp"
#include "rt_core/motion/trajectory.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::motion {

enum class TrajectoryOutcome : std::uint8_t {
  none,
  arrived,
  superseded,  // by a newer trajectory or another motion
  stopped,     // by command
  path_tolerance,
  goal_tolerance,
  blocked,  // the next step was refused: the robot stays where it was
};

struct TrajectoryState {
  bool moving = false;         // also while it brakes, or comes to the end that it has reached within its tolerances
  std::uint32_t running = 0;   // id; 0: none
  std::uint32_t finished = 0;  // the newest id that ended, however
  TrajectoryOutcome outcome = TrajectoryOutcome::none;    // of `finished`
  std::uint8_t joint = 0;                                 // that failed: path_tolerance, goal_tolerance
  double deviation = 0;                                   // of it, rad or m
  std::uint16_t given = 0;                                // joints (bits) of the newest one
  std::uint32_t point = 0;                                // where it goes to, of the newest one, from 0
  double elapsed = 0;                                     // s from the start of the newest one
  std::array<KnotState, kMaxJointsPerRobot> reference{};  // where it wants the joints; of `given`
};

// What a trajectory wants is followed as fast as the joints may: one that cannot follow lags behind, which the
// tolerances bound.
class TrajectoryFollower {
 public:
  // Another robot: everything is forgotten, the ids too.
  void reset(std::size_t joints) CELL_RT;
  // In place of what runs, from the present velocities (rad/s or m/s). Not owned: stays valid while running() gives it.
  // Points whose time has passed are left out: the joints go from where they are to the first one that has not. False,
  // and nothing is changed, where it is not sound or not newer than those before.
  bool begin(const Trajectory& trajectory, std::span<const double> velocities) CELL_RT;
  // Brakes all joints; the trajectory ends when they stand.
  void stop(TrajectoryOutcome outcome) CELL_RT;
  // At once, without braking.
  void abort(TrajectoryOutcome outcome) CELL_RT;
  [[nodiscard]] bool active() const CELL_RT { return phase_ != Phase::idle; }
  [[nodiscard]] const Trajectory* running() const CELL_RT { return trajectory_; }

  [[nodiscard]] std::uint32_t newest() const CELL_RT { return newest_; }  // id that was ever taken; 0: none

  // As MoveExecutor::step().
  bool step(double dt, Timestamp now, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT;
  [[nodiscard]] const TrajectoryState& state() const CELL_RT { return state_; }
  // How fast each joint may be in this step.
  [[nodiscard]] const JointValues& fastest() const CELL_RT { return fastest_; }

  // All that the next steps depend on, for a recording of the tick.
  template <class Archive>
  void transfer(Archive& archive, std::size_t joints) CELL_RT {
    joints_ = joints < kMaxJointsPerRobot ? joints : kMaxJointsPerRobot;
    archive.reference(trajectory_);
    archive.choice(phase_, Phase::stopping);
    archive.choice(stop_outcome_, TrajectoryOutcome::blocked);
    archive.choice(state_.outcome, TrajectoryOutcome::blocked);
    archive(begun_, start_, from_time_, velocities_, fastest_, deceleration_, newest_);
    archive.bounded(first_, kMostKnots);
    for (KnotState& knot : from_) archive(knot.position, knot.velocity, knot.acceleration);
    archive(state_.moving, state_.running, state_.finished, state_.joint, state_.deviation, state_.given,
            state_.elapsed, state_.point);
    for (KnotState& knot : state_.reference) archive(knot.position, knot.velocity, knot.acceleration);
    if constexpr (Archive::kReads) {
      const bool follows = phase_ == Phase::following || phase_ == Phase::settling;
      if (trajectory_ != nullptr && (!is_sound(*trajectory_, joints_) || first_ > trajectory_->points()))
        archive.fail();
      if (follows && trajectory_ == nullptr) archive.fail();
    }
  }

 private:
  enum class Phase : std::uint8_t { idle, following, settling, stopping };
  static constexpr std::size_t kMostKnots = 60'000;

  void start(double dt, Timestamp now, std::span<const double> q) CELL_RT;
  void sample(double t) CELL_RT;
  bool chase(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT;
  void check(double t, std::span<const double> q) CELL_RT;
  bool brake(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT;
  void finish(TrajectoryOutcome outcome) CELL_RT;
  void rest() CELL_RT;
  [[nodiscard]] bool moves(std::size_t joint) const CELL_RT { return (trajectory_->given >> joint & 1U) != 0; }

  std::size_t joints_ = 0;
  const Trajectory* trajectory_ = nullptr;
  Phase phase_ = Phase::idle;
  TrajectoryOutcome stop_outcome_ = TrajectoryOutcome::stopped;
  bool begun_ = false;     // it has had its first step
  Timestamp start_;        // of the trajectory's time
  double from_time_ = 0;   // s from its start: where it was taken up
  std::size_t first_ = 0;  // the point where that leads to
  std::array<KnotState, kMaxJointsPerRobot> from_{};
  JointValues velocities_{};  // of the last step
  JointValues fastest_{};
  JointValues deceleration_{};
  std::uint32_t newest_ = 0;  // id that was ever taken
  TrajectoryState state_;
};

}  // namespace cellmirror::motion
