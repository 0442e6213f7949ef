// Records the paths of TCPs as polylines of few points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "app/snapshot/trace_state.hpp"

namespace cellmirror::app {

// One trace for each robot that was given. A point is kept where the path would otherwise be further than kTolerance
// from the polyline, so that what is drawn does not depend on the rate of the samples. A frame is kept every kFrameStep
// of the path and every kFrameTurn. One thread; not real time.
class TraceRecorder {
 public:
  static constexpr std::size_t kTraces = 8;     // the one that waits longest goes
  static constexpr std::size_t kPoints = 4000;  // of a trace; the oldest go
  static constexpr std::size_t kFrames = 200;   // likewise
  static constexpr double kTolerance = 2e-4;    // m
  static constexpr double kFrameStep = 0.05;    // m
  static constexpr double kFrameTurn = 0.2;     // rad

  // True where the trace has changed. A pose that is not finite is passed over.
  bool extend(std::string_view robot, const Pose& X_WT);
  void clear() { traces_.clear(); }
  [[nodiscard]] bool empty() const { return traces_.empty(); }
  [[nodiscard]] std::vector<TcpTrace> traces() const;

 private:
  static constexpr std::size_t kMostPending = 256;  // bounds the work for a sample

  struct Trace {
    std::string robot;
    std::deque<Eigen::Vector3d> points;
    std::vector<Eigen::Vector3d> pending;  // samples behind the last point; a line to the newest passes them all
    std::deque<Pose> frames;
  };

  Trace& trace_of(std::string_view robot);
  static bool extend_path(Trace& trace, const Eigen::Vector3d& p);
  static bool extend_frames(Trace& trace, const Pose& X_WT);

  std::deque<Trace> traces_;  // the newest last
};

}  // namespace cellmirror::app
