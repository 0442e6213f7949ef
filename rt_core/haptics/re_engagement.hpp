// When a device whose fault says nothing against it engages again by itself: the hand rests outside of bodies, and the
// cause has been away for a while.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::haptics {

// What is known in a tick in which a fault is latched. World frame, SI.
struct FaultedTick {
  Timestamp now;
  HapticFault fault = HapticFault::none;
  bool by_itself = false;                          // HapticSettings::re_engage
  Timestamp last_bad;                              // the last tick with a cause of whatever kind
  const ContactModel* model = nullptr;             // of now; null: none, or too old
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();  // where the hand wants the tip
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
};

// True for faults of time and transport: a process that was late, ended or was replaced, a loop or a worker that was
// late. False for data and forces that are wrong: those stay until RESET_HAPTIC.
[[nodiscard]] bool passes_by_itself(HapticFault fault) CELL_RT;

class ReEngagement {
 public:
  static constexpr Nanoseconds kQuiet{500'000'000};   // without a cause
  static constexpr Nanoseconds kAtRest{500'000'000};  // within kRestRadius
  static constexpr double kRestRadius = 2e-3;         // m: the tremor of a hand that holds still is well below
  static constexpr double kDeepest = 1e-4;            // m: deeper is inside of a body

  // At the moment in which a fault is latched.
  void restart() CELL_RT { *this = ReEngagement(); }
  // Each tick while it is latched. `nothing`: the device may engage again now.
  HapticAwaited awaits(const FaultedTick& tick) CELL_RT;

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(place_, since_);
  }

 private:
  bool rests(Timestamp now, const Eigen::Vector3d& hand) CELL_RT;

  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Timestamp since_;  // when the hand came to place_; unknown: not yet
};

}  // namespace cellmirror::haptics
