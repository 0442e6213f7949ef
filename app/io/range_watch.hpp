// Notices joints of mirrored robots that are beyond the range of their model: a wrong scale or sign of the stream, or a
// model that is not the robot's.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/joint_range.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

// One thread.
class RangeWatch {
 public:
  // Warnings about the robots now, one for each joint that went beyond its range with a fresh value: not again
  // before it was back, nor within 10 s. `robots` and `snapshots` are in the same order.
  [[nodiscard]] std::vector<std::string> look(Timestamp now, std::span<const RobotState> robots,
                                              std::span<const RobotSnapshot> snapshots);

 private:
  struct Watched {
    bool told = false;  // and still beyond
    Timestamp at;       // of the last warning
  };
  std::map<std::string, std::array<Watched, kMaxJointsPerRobot>, std::less<>> robots_;
};

}  // namespace cellmirror::app
