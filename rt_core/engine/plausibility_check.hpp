// Whether the values that a stream brings can be those of the robot: by position, velocity and acceleration, and
// whether they change at all. Some nanoseconds a joint.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/capacity.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/plausibility.hpp"

namespace cellmirror::engine {

// One value of a joint: finite. rad or m, and their derivatives; zero where it is not sent.
struct StreamValue {
  double position = 0;
  double velocity = 0;
  double effort = 0;
  Timestamp receive_time;
};

struct PlausibilityVerdict {
  bool shown = true;  // the value may be taken: it is plausible, and so were enough before it
  Implausibility why = Implausibility::none;
  double value = 0;  // as in ImplausibleValue; where `why` is something
  double bound = 0;
};

// Tick thread only. Each value is compared with the one that was received before, whether that was shown or not: a
// robot that really is elsewhere (it was referenced again) is believed after some values, and two senders that answer
// alternately never are.
class PlausibilityCheck {
 public:
  // Forgets the values so far. Without bounds everything is plausible.
  void begin(const PlausibilityBounds& bounds) CELL_RT;
  void forget() CELL_RT { joints_ = {}; }  // discards the values so far
  PlausibilityVerdict check(std::size_t joint, const StreamValue& value) CELL_RT;
  // When a value of the joint came last, plausible or not.
  [[nodiscard]] Timestamp last_heard(std::size_t joint) const CELL_RT { return joints_[joint].heard; }
  void note_heard(std::size_t joint, Timestamp time) CELL_RT { joints_[joint].heard = time; }

  // Its members, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(bounds_, joints_);
  }

 private:
  struct Joint {
    template <class Archive>
    void transfer(Archive& archive) CELL_RT {
      archive(last.position, last.velocity, last.effort, last.receive_time, heard, changed, doubt);
    }

    StreamValue last;         // within the range; its time is "never" before the first one
    Timestamp heard;          // also where it was not within the range
    Timestamp changed;        // the first of the values that are equal to `last`
    std::uint16_t doubt = 0;  // plausible values that are still missing
  };

  [[nodiscard]] PlausibilityVerdict compare(const KnownLimits& bounds, const Joint& joint,
                                            const StreamValue& value) const CELL_RT;

  PlausibilityBounds bounds_;
  std::array<Joint, kMaxJointsPerRobot> joints_{};
};

}  // namespace cellmirror::engine
