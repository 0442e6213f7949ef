// Light barriers: a beam between two frames of the cell, which bodies interrupt.
#pragma once

#include <Eigen/Core>
#include <cstdint>
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
  std::string object;        // dotted path of a body in the beam; empty: none, or not known
  std::string short_object;  // its short name; empty: as `object`
  // A frame is not there or its pose is no number, or the shape of something in the cell is not known. A barrier whose
  // beam is not known counts as interrupted.
  bool doubtful = false;
  std::uint64_t interruptions = 0;  // how often it became interrupted, since the start
  bool placed = false;              // the ends of the beam are known: `from` and `to`, in the world, m
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
};

}  // namespace cellmirror
