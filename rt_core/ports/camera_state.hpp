// The commanded state of a camera, for the program that steers the real one (CAM_ONLINE, manual 1.2.1). SI.
#pragma once

#include <span>
#include <string>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// The optical axis is z; x points right in the image, y down.
struct CameraState {
  std::string name;    // of its workframe
  std::string tracks;  // dotted path of the tracked frame; empty: none
  // Commanded pose. For a mirrored camera that tracks nothing: the measured one.
  Pose X_WC = Pose::Identity();
  Pose X_WM = Pose::Identity();  // its mount: its pose with the pan-tilt head at zero; X_WC without a head
  double pan_rad = 0;            // R_MC = Ry(pan) Rx(tilt), as near as that comes to it
  double tilt_rad = 0;
  double focal_distance_m = 0;  // viewing distance; of a tracking camera the distance to what it tracks
  double fovy_rad = 0;          // vertical opening angle
  bool tracking = false;
  bool mirrored = false;  // its head is mirrored from a real one (ROBOT online)
};

// Receives the online cameras outside the tick. One calling thread (the publisher). Never blocks for long; what cannot
// be delivered is dropped and counted by the implementation.
class CameraOutput {
 public:
  virtual ~CameraOutput() = default;
  // `time`: the tick's instant.
  virtual void publish_cameras(Timestamp time, std::span<const CameraState> cameras) = 0;
};

}  // namespace cellmirror
