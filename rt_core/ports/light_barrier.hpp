// Light barriers: a beam between two frames of the cell, which bodies interrupt.
#pragma once

#include <string>

#include "rt_core/base/time.hpp"

namespace cellmirror {

struct LightBarrier {
  std::string name;
  std::string from;  // full dotted paths of the frames
  std::string to;
  double radius = 0.005;  // m, of the beam
};

struct BarrierReading {
  std::string name;
  Timestamp posture_time;  // the tick's instant
  bool interrupted = false;
  std::string object;  // dotted path of a body in the beam; empty: none, or not known
  // A frame is not there or its pose is no number, or the shape of something in the cell is not known. A barrier whose
  // beam is not known counts as interrupted.
  bool doubtful = false;
};

}  // namespace cellmirror
