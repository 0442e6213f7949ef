// The only way of joint values out of the tick: it holds the published state of one robot, and nothing else writes it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/engine/limiter.hpp"
#include "rt_core/engine/plausibility_check.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::engine {

using JointSet = std::uint16_t;  // bit 0: the first joint
static_assert(kMaxJointsPerRobot <= 16, "sets of joints have 16 bits");

// Joints that a step moves, and how fast they may be in it.
struct GatedStep {
  JointSet joints = 0;
  JointValues next{};      // rad or m
  JointValues velocity{};  // rad/s or m/s, as it is published
  JointValues fastest{};   // rad/s or m/s: never faster than this, nor than the limits of the robot
  double dt = 0;           // s
};

// Tick thread only. What is refused is refused for all of its joints, so that a robot is never sent to half of a
// posture; it is counted (RobotTickState::refused_setpoints), and the robot stands.
class JointGate {
 public:
  [[nodiscard]] const RobotTickState& state() const CELL_RT { return state_; }
  [[nodiscard]] const JointLimits& limits() const CELL_RT { return limits_; }

  // Whether a robot may begin like this: finite, within its limits of position.
  [[nodiscard]] static LimiterVerdict check_start(std::uint8_t joint_count, std::span<const double> positions,
                                                  const JointLimits& limits) CELL_RT;
  // A simulated robot. Only what check_start() passes is taken.
  LimiterVerdict add(std::uint8_t joint_count, std::span<const double> positions, const JointLimits& limits) CELL_RT;
  void remove() CELL_RT { *this = JointGate(); }
  // The robot stays where it is. `given`: the joints whose position the stream gives; none: as if it gave all.
  // `bounds`: of what a mirrored robot may send; null: everything is plausible.
  void set_mode(RobotMode mode, const StreamAges& ages, JointSet given,
                const PlausibilityBounds* bounds = nullptr) CELL_RT;
  void set_limits(const JointLimits& limits) CELL_RT { limits_ = limits; }

  // Of a simulated robot.
  // To other positions at once, which is no motion: only the limits of position count. `joints` go.
  LimiterVerdict jump(const JointValues& positions, JointSet joints) CELL_RT;
  // A joint that stands beyond its limits of position, since they were narrowed, may come back and not go further.
  LimiterVerdict step(const GatedStep& step) CELL_RT;
  // How a joint of a simulated robot moved in the tick before.
  [[nodiscard]] const JointRate& rate(std::size_t joint) const CELL_RT { return rates_[joint]; }
  // In this tick these joints do not move.
  void stand(JointSet joints) CELL_RT;

  // Of a mirrored robot, which is shown where it says that it is, as far as that is plausible. Values that are not
  // finite are refused joint by joint; the joint keeps its last good value and becomes invalid. So do all of a sample
  // without a time of receipt, or with one that has not come yet. In the same way values that cannot be true make the
  // joint implausible, and a second sender makes it conflicting.
  void take(const JointSample& sample, Timestamp now) CELL_RT;
  // Updates the states of the joints by the age of their values at `now`.
  void age(Timestamp now) CELL_RT;

  // What goes with the joint values, and is none.
  void set_motion(const motion::MotionState& motion) CELL_RT { state_.motion = motion; }
  void set_follow(const FollowTickState& follow) CELL_RT { state_.follow = follow; }

  // A part of what is published: transfer_part() (state_transfer.hpp).
  template <class Archive>
  void transfer_published(Archive& archive, std::size_t part) CELL_RT {
    transfer_part(archive, state_, part);
  }
  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    transfer_state(archive, state_);
    archive(limits_, ages_.stale_after, ages_.lost_after, given_, rates_, plausibility_);
  }

 private:
  LimiterVerdict refuse(LimiterVerdict verdict) CELL_RT;
  void take_joint(const JointSample& sample, std::size_t i) CELL_RT;
  void note_implausible(std::size_t i, const PlausibilityVerdict& verdict, Timestamp receive_time) CELL_RT;
  void age_joint(std::size_t i, Timestamp now) CELL_RT;
  [[nodiscard]] LimiterVerdict check(const GatedStep& step,
                                     std::array<JointRate, kMaxJointsPerRobot>& rates) const CELL_RT;

  RobotTickState state_;
  JointLimits limits_;
  StreamAges ages_;
  JointSet given_ = 0xFFFF;                            // joints whose position the stream gives; never 0
  std::array<JointRate, kMaxJointsPerRobot> rates_{};  // of the tick before
  PlausibilityCheck plausibility_;
};

}  // namespace cellmirror::engine
