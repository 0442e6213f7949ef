// Whether a body has come to be where the tip is, rather than moved there: only what moves may push the hand.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::haptics {

// Surfaces that come faster at the tip count as bodies that appear.
inline constexpr double kFastestSurface = 0.5;  // m/s
// Likewise, for kAfterChange after a model of a cell that was changed: a body that a program moves in small steps
// pushes.
inline constexpr double kFastestPlaced = 0.1;  // m/s
inline constexpr Nanoseconds kAfterChange{50'000'000};
// m: what may come at once beyond that. A step of a body that a program moves a hundred times a second, and what the
// planes of a bent surface differ by from one posture to the next.
inline constexpr double kLargestStep = 1.5e-3;
// Of the time between two models only so much counts: changes of a cell make it long, and are no motion.
inline constexpr Nanoseconds kLongestBetween{10'000'000};

// m: the way out of all constraints for a tip at `x`. 0 where it meets them all, and where no point does: then the tip
// is clamped, and nothing pushes it. Bounded time, as nearest_point().
[[nodiscard]] double tip_depth(const ContactModel& model, const Eigen::Vector3d& x) CELL_RT;

class AppearanceWatch {
 public:
  void restart() CELL_RT { *this = AppearanceWatch{}; }
  // `now` replaces `before` while the tip is at `x` (m). True if surfaces have covered the tip deeper than they can
  // have moved since; then it restarts. Depth that shows bit by bit, model after model, adds up. Bounded time: two
  // searches of nearest_point().
  bool appeared(const ContactModel& before, const ContactModel& now, const Eigen::Vector3d& x) CELL_RT;
  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(ahead_, changed_);
  }

 private:
  double ahead_ = 0;  // m, that the surfaces have come beyond what their greatest speed explains
  Timestamp changed_;
};

}  // namespace cellmirror::haptics
