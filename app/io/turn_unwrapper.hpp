// Joints that turn without end, whose source starts again after each turn: makes their positions go on. One source
// thread.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/capacity.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::app {

// Between a stream and the inlet of its robot, so that the check of plausibility, pictures, charts and recordings get
// one motion. A position that a source gives within one turn of zero is continued from the one before, by the shorter
// way; one that is beyond is a count of the source's own, and taken as it is.
class TurnUnwrapper final : public JointSampleSink {
 public:
  // `joints`: bit i for joint i, in rad. `inner` outlives this.
  TurnUnwrapper(JointSampleSink& inner, std::uint32_t joints) : inner_(&inner), joints_(joints) {}

  // A stream is opened: nothing is known of its source.
  void restart() { joints_state_ = {}; }

  bool push(const JointSample& sample) noexcept override;

 private:
  struct Joint {
    bool known = false;
    double last = 0;   // rad, as the source gave it
    double turns = 0;  // that are added, in rad
  };

  JointSampleSink* inner_;
  std::uint32_t joints_;
  std::array<Joint, kMaxJointsPerRobot> joints_state_{};
};

}  // namespace cellmirror::app
