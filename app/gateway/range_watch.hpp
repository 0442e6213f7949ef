// Notices joints of mirrored robots that are beyond the range of their model: a wrong scale or sign of the stream, or a
// model that is not the robot's.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/gateway/picture.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

// Whether a joint stands outside; rad or m. A tenth of a millimetre (of a milliradian) counts as on the limit: encoders
// read a little more there.
[[nodiscard]] bool is_beyond(double position, double lower, double upper);

// One thread.
class RangeWatch {
 public:
  // What is to be told about the robots now, one text a joint that went beyond its range with a fresh value: not again
  // before it was back, nor within 10 s. `robots` and `pictures` are in the same order.
  [[nodiscard]] std::vector<std::string> look(Timestamp now, std::span<const RobotState> robots,
                                              std::span<const RobotPicture> pictures);

 private:
  struct Watched {
    bool told = false;  // and still beyond
    Timestamp at;       // when it was told last
  };
  std::map<std::string, std::array<Watched, kMaxJointsPerRobot>, std::less<>> robots_;
};

}  // namespace cellmirror::app
