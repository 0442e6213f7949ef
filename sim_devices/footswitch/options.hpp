// What the command line of sim_footswitch says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_devices/footswitch/switch_plan.hpp"

namespace cellmirror::sim {

struct FootSwitchOptions {
  std::int32_t key = 0;
  std::uint64_t bytes = 1;
  std::vector<SwitchChange> plan;    // bounces included
  double for_s = 0;                  // at least so long; longer where the plan is; -1: until a signal
  std::vector<std::uint32_t> holds;  // opened again at the end
  double wait_s = 0;                 // for the memory; 0: as long as it takes
  int priority = 0;
  std::string log;
  std::string control;
  bool no_input = false;  // no effect: for compatibility with sim_robot
  double gap_s = 0.1;     // of sequences that come by command
  bool json = false;
  bool quiet = false;
};

}  // namespace cellmirror::sim
