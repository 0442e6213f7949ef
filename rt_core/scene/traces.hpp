// The trace of the active robot's TCP (SET_MODE SMEAR).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::scene {

// One for each robot that was active since the mode was switched on; off forgets them. The TCP is sampled
// with each scene that is built.
class Traces {
 public:
  static constexpr std::size_t kTraces = 8;      // the one that waits longest goes
  static constexpr double kShortestStep = 5e-4;  // m: less is no new point

  void draw(const SceneInput& input, Scene& scene);

 private:
  struct Trace {
    std::string robot;
    std::deque<Eigen::Vector3f> points;
  };
  void extend(const SceneInput& input);
  Trace& trace_of(const std::string& robot);

  std::deque<Trace> traces_;  // the newest last
  std::uint64_t smear_ends_ = 0;
};

}  // namespace cellmirror::scene
