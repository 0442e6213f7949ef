// Where commands for the simulation of tissue go: its worker implements it.
#pragma once

#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/command.hpp"

namespace cellmirror::app {

class TissuePort {
 public:
  virtual ~TissuePort() = default;
  // From the thread that owns the cell; does not wait. The simulation applies all of them, in this order, between the
  // same two steps. Bounded: refused as a whole, with the reason, where they do not fit.
  virtual Result<void> request(std::vector<tissue::Command> commands) = 0;
};

}  // namespace cellmirror::app
