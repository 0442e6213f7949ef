// Carries out the moves of one robot, tick by tick. Belongs to the tick thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/linear.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/ptp.hpp"

namespace cellmirror::motion {

inline constexpr std::size_t kMoveQueue = 32;  // moves that wait, of each robot

enum class Outcome : std::uint8_t {
  none,
  arrived,
  stopped,     // by command
  superseded,  // by a newer move
  blocked,     // the next step was impossible, or the tick refused the move: the robot stays where it was
};

struct MotionState {
  bool moving = false;              // also while it brakes, and in a delay
  std::uint8_t waiting = 0;         // moves in the queue
  std::uint32_t running = 0;        // id of the move that runs; 0: none
  std::uint32_t finished = 0;       // the newest id that ended, however
  std::uint32_t finished_from = 0;  // the oldest of those that ended together with `finished`
  Outcome outcome = Outcome::none;  // of finished_from .. finished
  // When they ended, exactly: moves end between ticks. What the move began late and could not make up for is deducted,
  // so that the times of a program's moves add up.
  Timestamp finished_time;
  double pace = 1;  // rate of time on its path, by set_pace(): 0 is held and at rest
};

// All its memory is inside (some 30 kB): put it on the heap as part of its owner.
class MoveExecutor {
 public:
  // Another robot: everything is forgotten, the ids too.
  void reset(std::size_t joints) CELL_RT;
  // For the linear moves that are added from now on; null: linear moves are refused. Not owned: must stay valid as long
  // as uses() returns true for it.
  void set_chain(const kinematics::Chain* chain) CELL_RT { chain_ = chain; }
  // Whether moves that run, wait or may still be added need this chain.
  [[nodiscard]] bool uses(const kinematics::Chain& chain) const CELL_RT;

  // False where the queue is full or the move is not sound; its id ends as blocked, when everything before it has
  // ended.
  bool add(const Move& move) CELL_RT;
  // Rate of time on the path, 0..1: 0 brakes on the path and stays there until another pace is set; queued moves do not
  // begin, and delays pause. The pace changes as fast as the accelerations of the move allow. A superseding move,
  // stop() and abort() reset it to 1. Values beyond are clamped.
  void set_pace(double pace) CELL_RT;
  // Moves with ids beyond this one wait until another one is set: the robot stops at its end, even at a fly point. 0:
  // none waits. Reset like a pace.
  void hold_behind(std::uint32_t id) CELL_RT { gate_ = id; }
  // Brakes on the own path; all running and queued moves end as stopped when the robot is at rest.
  void stop() CELL_RT { halt(Outcome::stopped); }
  // At once, without braking; everything that runs or waits ends.
  void abort(Outcome outcome) CELL_RT;

  // `dt` seconds (not negative) on, to the instant `now`: from the posture `q` [rad or m] to the next, whose velocities
  // are put into `qd`. `q` is the result of the previous step, or the robot's new position. False, and q and qd
  // unchanged, if the robot is at rest.
  bool step(double dt, Timestamp now, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT;

  [[nodiscard]] const MotionState& state() const CELL_RT { return state_; }
  // How fast each joint may be in this step: max_velocity of the move, or the speed from which it brakes.
  [[nodiscard]] const JointValues& fastest() const CELL_RT { return fastest_; }

  // All that the next steps depend on, for a recording of the tick (rt_core/base/state_bytes.hpp). What is read is
  // refused where it would not fit a robot with `joints` joints.
  template <class Archive>
  void transfer(Archive& archive, std::size_t joints) CELL_RT {
    joints_ = std::min(joints, kMaxJointsPerRobot);
    archive.reference(chain_);
    archive(state_);
    archive.choice(activity_, Activity::delay);
    archive.choice(halt_outcome_, Outcome::blocked);
    archive(blend_, brake_, braking_, halt_through_, newest_, delay_left_, pace_, wanted_pace_, gate_, now_, dt_, late_,
            lag_, qd_, fastest_);
    if (activity_ == Activity::joints) ptp_.transfer(archive, joints_);
    if (activity_ == Activity::path) archive(linear_);
    if constexpr (Archive::kReads) first_ = 0;
    for (std::size_t i = 0; i < state_.waiting && i < kMoveQueue; ++i) {
      Queued& queued = queue_[(first_ + i) % kMoveQueue];
      archive(queued.move);
      archive.reference(queued.chain);
    }
    if constexpr (Archive::kReads) {
      const bool on_path = activity_ == Activity::path;
      const bool nowhere = on_path && (linear_.chain() == nullptr || linear_.chain()->variable_count() != joints_);
      if (nowhere || (blend_ && state_.waiting == 0)) archive.fail();
    }
  }

 private:
  struct Queued {
    Move move;
    const kinematics::Chain* chain = nullptr;
  };
  enum class Activity : std::uint8_t { standing, joints, path, delay };

  [[nodiscard]] const Queued& front() const CELL_RT { return queue_[first_]; }
  bool push(const Move& move) CELL_RT;
  void pop() CELL_RT;
  void supersede(const Move& move) CELL_RT;
  void halt(Outcome outcome) CELL_RT;
  [[nodiscard]] bool blends(const Move& move) const CELL_RT;
  [[nodiscard]] bool flies(const JointRange& range, std::span<const double> q) const CELL_RT;
  void fly(const JointRange& range, std::span<const double> q) CELL_RT;
  bool start_path(std::span<const double> q) CELL_RT;
  bool start_joints(const JointRange& range, std::span<const double> q) CELL_RT;
  void start_front(const JointRange& range, std::span<const double> q) CELL_RT;
  [[nodiscard]] double lag_of(const Move& move) const CELL_RT;
  void go_on_with_pace(double dt) CELL_RT;
  void end_holds() CELL_RT;
  [[nodiscard]] bool may_begin(const Move& move) const CELL_RT { return gate_ == 0 || move.id <= gate_; }
  void brake(const JointRange& range, std::span<const double> q) CELL_RT;
  void brake_off_line(const JointRange& range, std::span<const double> q) CELL_RT;
  bool advance(double dt, const JointRange& range, std::span<double> q) CELL_RT;
  bool advance_path(double dt, const JointRange& range, std::span<double> q) CELL_RT;
  void arrive() CELL_RT;
  // `overrun`: how long before now_, s.
  void end_through(std::uint32_t id, Outcome outcome, double overrun = 0) CELL_RT;
  [[nodiscard]] double overrun() const CELL_RT;
  void come_to_rest() CELL_RT;
  void rest() CELL_RT;

  std::size_t joints_ = 0;
  const kinematics::Chain* chain_ = nullptr;
  MotionState state_;
  Activity activity_ = Activity::standing;
  bool blend_ = false;              // the front of the queue starts out of the motion
  bool brake_ = false;              // braking is requested
  bool braking_ = false;            // and under way
  std::uint32_t halt_through_ = 0;  // ids that end as halt_outcome_ when the robot is at rest; 0: none
  Outcome halt_outcome_ = Outcome::stopped;
  std::uint32_t newest_ = 0;  // the newest id that was ever given
  PtpMotion ptp_;
  LinearMotion linear_;
  double delay_left_ = 0;
  double pace_ = 1;  // of the path, as it is
  double wanted_pace_ = 1;
  std::uint32_t gate_ = 0;  // hold_behind(); 0: none
  Timestamp now_;           // of the step under way, or of the last one
  double dt_ = 0;           // s
  double late_ = 0;         // by which the move that runs began late and which it does not make up for, s
  // By which the front of the queue is late because the move before ended within the last step, s.
  static constexpr double kNoLag = -1;
  double lag_ = kNoLag;
  JointValues qd_{};
  JointValues fastest_{};
  std::array<Queued, kMoveQueue> queue_{};
  std::size_t first_ = 0;
};

}  // namespace cellmirror::motion
