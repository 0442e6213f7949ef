#include "app/workers/trace_recorder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace cellmirror::app {

namespace {

using Eigen::Vector3d;

constexpr double kShortestStep = 5e-5;  // m: less is standing still

double distance_to_line(const Vector3d& p, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  const double squared = along.squaredNorm();
  const double part = squared > 0.0 ? std::clamp((p - from).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - from - part * along).norm();
}

}  // namespace

TraceRecorder::Trace& TraceRecorder::trace_of(std::string_view robot) {
  const auto at = std::ranges::find(traces_, robot, &Trace::robot);
  if (at != traces_.end()) {
    // To the end, among those used last.
    std::rotate(at, std::next(at), traces_.end());
    return traces_.back();
  }
  if (traces_.size() == kTraces) traces_.pop_front();
  traces_.push_back({.robot = std::string(robot), .points = {}, .pending = {}, .frames = {}});
  return traces_.back();
}

bool TraceRecorder::extend_path(Trace& trace, const Vector3d& p) {
  if (trace.points.empty()) {
    trace.points.push_back(p);
    return true;
  }
  const Vector3d& newest = trace.pending.empty() ? trace.points.back() : trace.pending.back();
  if ((p - newest).norm() < kShortestStep) return false;
  const auto passed = [&](const Vector3d& sample) {
    return distance_to_line(sample, trace.points.back(), p) <= kTolerance;
  };
  if (trace.pending.size() == kMostPending || !std::ranges::all_of(trace.pending, passed)) {
    trace.points.push_back(trace.pending.back());
    trace.pending.clear();
    if (trace.points.size() > kPoints) trace.points.pop_front();
  }
  trace.pending.push_back(p);
  return true;
}

bool TraceRecorder::extend_frames(Trace& trace, const Pose& X_WT) {
  if (!trace.frames.empty()) {
    const Pose& last = trace.frames.back();
    const double step = (X_WT.translation() - last.translation()).norm();
    const double turn = Eigen::AngleAxisd(Eigen::Matrix3d(last.linear().transpose() * X_WT.linear())).angle();
    if (step < kFrameStep && turn < kFrameTurn) return false;
  }
  trace.frames.push_back(X_WT);
  if (trace.frames.size() > kFrames) trace.frames.pop_front();
  return true;
}

bool TraceRecorder::extend(std::string_view robot, const Pose& X_WT) {
  if (!X_WT.matrix().allFinite()) return false;
  Trace& trace = trace_of(robot);
  const bool moved = extend_path(trace, X_WT.translation());
  return extend_frames(trace, X_WT) || moved;
}

std::vector<TcpTrace> TraceRecorder::traces() const {
  std::vector<TcpTrace> out;
  for (const Trace& trace : traces_) {
    TcpTrace& made = out.emplace_back();
    made.robot = trace.robot;
    made.points.reserve(trace.points.size() + 1);
    for (const Vector3d& p : trace.points) made.points.push_back(p.cast<float>());
    if (!trace.pending.empty()) made.points.push_back(trace.pending.back().cast<float>());
    made.frames.assign(trace.frames.begin(), trace.frames.end());
  }
  return out;
}

}  // namespace cellmirror::app
