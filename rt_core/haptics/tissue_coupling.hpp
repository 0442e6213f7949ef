// What a hand feels of soft tissue between two responses of the worker that computes it: which response counts, how far
// and how long it counts, and the force and torque at the tip. Forces are those on the hand.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/haptics/tip_solver.hpp"
#include "rt_core/haptics/tissue_force.hpp"

namespace cellmirror::haptics {

// Of a response, since the tick of its posture.
inline constexpr Nanoseconds kTissueLate{5'000'000};       // older: counted as late
inline constexpr Nanoseconds kTissueExpires{100'000'000};  // older: its force fades out
inline constexpr Nanoseconds kTissueFade{100'000'000};     // in which it does so, and fades in again
// m, of the tip from where it was computed for: up to the first the stiffness counts, then the force stays as it is;
// between the other two it fades out, since the response is of another place.
inline constexpr double kTissueReach = 5e-3;
inline constexpr double kTissueDistant = 10e-3;
inline constexpr double kTissueElsewhere = 20e-3;

// The instrument's tip in this tick.
struct TissueTip {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();        // m, world
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    // of the tool, unit vector, world
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();  // rad/m: turning * v is how fast the tool turns if the tip moves
};
// For an instrument whose tool can turn about its own axis alone while its tip rests (a trocar): so it turns when its
// tip moves. Instruments of more than four joints choose their orientation freely, and `turning` is zero. `R_WB`: of
// the instrument's base.
[[nodiscard]] TissueTip tissue_tip(const TipPosture& tip, const Pose& X_WB) CELL_RT;

struct TissueLimits {
  double stiffness = 0;    // N/m: stiffer tissue is felt as soft as that; less where responses come late
  double torque = 0;       // Nm, about the tool axis
  double torque_rate = 0;  // Nm/s
};

struct TissueReaction {
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();  // N, at the tip
  double axis_torque = 0;                             // Nm, about the tool axis
  double stored = 0;                                  // J, at most what the tissue may give back
};

class TissueCoupling {
 public:
  // Nothing is known; what was counted stays.
  void restart() CELL_RT;
  // Each tick. `newest` null: none exists. A response of another instrument, or without sequence, is ignored; one with
  // values that cannot be true (not finite, beyond all bounds, a stiffness that is not symmetric and positive
  // semi-definite, a posture time that is ahead or goes back) is refused and counted. Then the last one ages.
  void take(const TissueForce* newest, std::uint8_t slot, Timestamp now, double period) CELL_RT;
  // The force at the tip, faded by the engagement's `share` (0 to 1). A response that differs from what the last one
  // said for this place replaces it smoothly, within half the time between them. Bounded time, no heap.
  TissueReaction react(const TissueTip& tip, const TissueLimits& limits, double share, double period) CELL_RT;
  // There was no force in this tick: the next one does not go on from an earlier one.
  void release() CELL_RT;

  [[nodiscard]] bool known() const CELL_RT { return known_; }
  // The newest that counts; all zero where none does.
  [[nodiscard]] const TissueForce& newest() const CELL_RT { return force_; }
  [[nodiscard]] std::uint64_t late() const CELL_RT { return late_; }
  [[nodiscard]] std::uint64_t refused() const CELL_RT { return refused_; }

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(known_, fresh_, counted_late_, force_, steepness_, smoothing_, taken_, seen_, seen_time_, share_, lag_,
            correction_, last_, last_torque_, late_, refused_);
  }

 private:
  void accept(const TissueForce& response, Timestamp now) CELL_RT;
  [[nodiscard]] double softening(double stiffest) const CELL_RT;
  [[nodiscard]] Eigen::Vector3d smoothed(const Eigen::Vector3d& force, double period) CELL_RT;

  bool known_ = false;
  bool fresh_ = false;  // not yet reacted to
  bool counted_late_ = false;
  TissueForce force_;
  double steepness_ = 0;    // N/m, no direction of the stiffness is stiffer
  double smoothing_ = 0;    // s, in which a new response replaces the last one
  Timestamp taken_;         // when the newest came
  std::uint64_t seen_ = 0;  // sequence and posture time of the last one looked at
  Timestamp seen_time_;
  double share_ = 0;                                      // by age
  double lag_ = 0;                                        // s, the largest age of late
  Eigen::Vector3d correction_ = Eigen::Vector3d::Zero();  // N, left of what the last response said otherwise
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();        // N, of the last tick
  double last_torque_ = 0;                                // Nm, likewise
  std::uint64_t late_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace cellmirror::haptics
