// What the command line of sim_haptic says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_devices/haptic/axes.hpp"
#include "sim_devices/haptic/hand.hpp"
#include "sim_devices/haptic/haptic_fault.hpp"
#include "sim_devices/haptic/motion_script.hpp"

namespace cellmirror::sim {

struct HapticOptions {
  std::int32_t key = 0;
  int axes_given = 6;    // 4 to 7
  std::size_t axes = 6;  // the same
  double rate_hz = 1000;
  std::vector<MotionStep> motion;
  bool repeat = false;
  Coordinates start{};              // m and rad
  double length_resolution = 1e-5;  // m, of the encoders; 0: exact
  double angle_resolution = 1e-4;   // rad
  HandParameters hand;
  std::vector<HapticFaultSpec> faults;
  double for_s = -1;   // negative: to the end of the motion; 0: until a signal
  double wait_s = 0;   // for the memory; 0: as long as it takes
  double poll_us = 0;  // polling of the answer within a period; 0: once per period
  int priority = 0;
  bool watch = false;  // read only: nothing is written
  std::string log;
  std::string control;
  bool no_input = false;  // no effect: for compatibility with sim_robot
  bool json = false;
  bool quiet = false;
};

}  // namespace cellmirror::sim
