// Makes the positions of continuous joints continuous if their source wraps after each turn. One source thread.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/capacity.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::app {

// Sits between a stream and the inlet of its robot, so that the plausibility check, pictures, charts and recordings see
// one motion. Continues positions within one turn of zero from the previous one by the shorter way. A position beyond
// one turn shows that the source itself counts turns: it passes unchanged.
class TurnUnwrapper final : public JointSampleSink {
 public:
  // `joints`: bit i for joint i, in rad. `inner` outlives this.
  TurnUnwrapper(JointSampleSink& inner, std::uint32_t joints) : inner_(&inner), joints_(joints) {}

  // Discards the state of the previous source.
  void restart() { joints_state_ = {}; }

  bool push(const JointSample& sample) noexcept override;

 private:
  struct Joint {
    bool known = false;
    double last = 0;   // rad, as the source gave it
    double turns = 0;  // offset that is added, in rad
  };

  JointSampleSink* inner_;
  std::uint32_t joints_;
  std::array<Joint, kMaxJointsPerRobot> joints_state_{};
};

}  // namespace cellmirror::app
