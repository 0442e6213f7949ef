// Carries out the moves of one robot, tick by tick. Belongs to the tick thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
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
  blocked,     // the next step could not be met, or the move was refused by the tick: the robot stands where it was
};

struct MotionState {
  bool moving = false;              // also while it brakes, and in a delay
  std::uint8_t waiting = 0;         // moves in the queue
  std::uint32_t running = 0;        // id of the move that runs; 0: none
  std::uint32_t finished = 0;       // the newest id that ended, however
  std::uint32_t finished_from = 0;  // the oldest of those that ended together with `finished`
  Outcome outcome = Outcome::none;  // of finished_from .. finished
};

// All its memory is inside (some 30 kB): put it on the heap as part of its owner.
class MoveExecutor {
 public:
  // Another robot: everything is forgotten, the ids too.
  void reset(std::size_t joints) CELL_RT;
  // For the linear moves that are added from now on; null: linear moves are refused. Not owned: it has to live until
  // another one was set and every move that was added before has ended by its id (MotionState::finished), seen after a
  // step.
  void set_chain(const kinematics::Chain* chain) CELL_RT { chain_ = chain; }

  // False where the queue is full or the move is not sound; its id ends as blocked, when everything before it has
  // ended.
  bool add(const Move& move) CELL_RT;
  // Brakes on the own path; everything that runs or waits ends as stopped when the robot stands.
  void stop() CELL_RT { halt(Outcome::stopped); }
  // At once, without braking; everything that runs or waits ends.
  void abort(Outcome outcome) CELL_RT;

  // `dt` seconds (not negative) on: from the posture `q` [rad or m] to the next, whose velocities are put into `qd`.
  // `q` is what the step before left, or where the robot was put meanwhile. False, and q and qd untouched, where the
  // robot stands.
  bool step(double dt, const JointRange& range, std::span<double> q, std::span<double> qd) CELL_RT;

  [[nodiscard]] const MotionState& state() const CELL_RT { return state_; }
  // How fast each joint may be in this step: max_velocity of the move, or the speed from which it brakes.
  [[nodiscard]] const JointValues& fastest() const CELL_RT { return fastest_; }

 private:
  struct Queued {
    Move move;
    const kinematics::Chain* chain = nullptr;
  };
  enum class Activity : std::uint8_t { standing, joints, linear, delay };

  [[nodiscard]] const Queued& front() const CELL_RT { return queue_[first_]; }
  bool push(const Move& move) CELL_RT;
  void pop() CELL_RT;
  void supersede(const Move& move) CELL_RT;
  void halt(Outcome outcome) CELL_RT;
  [[nodiscard]] bool blends(const Move& move) const CELL_RT;
  [[nodiscard]] bool flies() const CELL_RT;
  void fly() CELL_RT;
  bool start_linear(std::span<const double> q) CELL_RT;
  void start_front(const JointRange& range, std::span<const double> q) CELL_RT;
  void brake(const JointRange& range, std::span<const double> q) CELL_RT;
  void brake_off_line(const JointRange& range, std::span<const double> q) CELL_RT;
  bool advance(double dt, const JointRange& range, std::span<double> q) CELL_RT;
  bool advance_linear(double dt, const JointRange& range, std::span<double> q) CELL_RT;
  void arrive() CELL_RT;
  void end_through(std::uint32_t id, Outcome outcome) CELL_RT;
  void come_to_rest() CELL_RT;

  std::size_t joints_ = 0;
  const kinematics::Chain* chain_ = nullptr;
  MotionState state_;
  Activity activity_ = Activity::standing;
  bool blend_ = false;              // the front of the queue starts out of the motion
  bool brake_ = false;              // braking is asked for
  bool braking_ = false;            // and under way
  std::uint32_t halt_through_ = 0;  // ids that end as halt_outcome_ when the robot stands; 0: none
  Outcome halt_outcome_ = Outcome::stopped;
  std::uint32_t newest_ = 0;  // the newest id that was ever given
  PtpMotion ptp_;
  LinearMotion linear_;
  double delay_left_ = 0;
  JointValues qd_{};
  JointValues fastest_{};
  std::array<Queued, kMoveQueue> queue_{};
  std::size_t first_ = 0;
};

}  // namespace cellmirror::motion
