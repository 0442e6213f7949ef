// What the motion service has to know of robots that follow others (MASTER_SLAVE).
#pragma once

#include <cstdint>
#include <string_view>

namespace cellmirror::app {

class CoupledRobots {
 public:
  virtual ~CoupledRobots() = default;
  // The joints of a robot that follow a master, bit 0 the first; 0 where it follows nobody.
  [[nodiscard]] virtual std::uint16_t coupled_joints(std::string_view robot) const = 0;
  // Whom it follows; empty: nobody.
  [[nodiscard]] virtual std::string_view master_of(std::string_view robot) const = 0;
};

}  // namespace cellmirror::app
