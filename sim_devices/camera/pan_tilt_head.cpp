#include "sim_devices/camera/pan_tilt_head.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace cellmirror::sim {

PanTiltHead::PanTiltHead(const HeadConfig& config)
    : axes_{HeadAxis(config.limits[0], config.start[0]), HeadAxis(config.limits[1], config.start[1])},
      goal_{axes_[0].position(), axes_[1].position()} {}

void PanTiltHead::start(Timestamp now) {
  last_ = now;
  for (HeadFault& fault : faults_) fault.origin = now;
}

HeadFault* PanTiltHead::in_force(HeadFaultKind kind, int joint, Timestamp now) {
  const auto found = std::ranges::find_if(faults_, [&](const HeadFault& fault) {
    return fault.spec.kind == kind && (fault.spec.joint == 0 || fault.spec.joint == joint) && fault.in_force(now);
  });
  if (found == faults_.end()) return nullptr;
  ++found->applied;
  return &*found;
}

void PanTiltHead::follow(const CameraRecord& record, Timestamp now) {
  if (record.mirrored && !record.tracking) {
    ++counters_.echoes;
    return;
  }
  if (!std::isfinite(record.pan) || !std::isfinite(record.tilt) || in_force(HeadFaultKind::deaf, 0, now) != nullptr) {
    ++counters_.ignored;
    return;
  }
  ++counters_.followed;
  const HeadAngles goal{axes_[0].within_stops(record.pan), axes_[1].within_stops(record.tilt)};
  if (goal != HeadAngles{record.pan, record.tilt}) ++counters_.beyond;
  if (const HeadFault* late = in_force(HeadFaultKind::late, 0, now)) {
    const auto delay = Nanoseconds(static_cast<std::int64_t>(late->spec.delay_s * 1e9));
    if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
    waiting_.push_back({now + delay, goal});
  } else {
    waiting_.clear();
    goal_ = goal;
  }
}

void PanTiltHead::advance(Timestamp now) {
  const double dt = seconds(now - last_);
  if (dt <= 0) return;
  last_ = now;
  while (!waiting_.empty() && waiting_.front().due <= now) {
    goal_ = waiting_.front().goal;
    waiting_.pop_front();
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) move(i, now, dt);
}

void PanTiltHead::move(std::size_t axis, Timestamp now, double dt) {
  const int joint = static_cast<int>(axis) + 1;
  if (held_ || in_force(HeadFaultKind::stuck, joint, now) != nullptr) {
    axes_[axis].stop();
    return;
  }
  const bool runs_away = in_force(HeadFaultKind::runaway, joint, now) != nullptr;
  const HeadFault* slow = in_force(HeadFaultKind::slow, joint, now);
  axes_[axis].step(runs_away ? axes_[axis].limits().most : goal_[axis], slow != nullptr ? slow->spec.scale : 1.0, dt);
}

void PanTiltHead::forget_past_faults(Timestamp now) {
  std::erase_if(faults_, [now](const HeadFault& fault) { return fault.over(now); });
}

Result<int> PanTiltHead::add_fault(const HeadFaultSpec& spec, Timestamp now) {
  forget_past_faults(now);
  if (faults_.size() >= kMostFaults) {
    return fail("there are " + std::to_string(kMostFaults) + " faults already", "`clear` ends them");
  }
  faults_.push_back({next_fault_, spec, now, false, 0});
  return next_fault_++;
}

std::size_t PanTiltHead::end_faults(int id, std::optional<HeadFaultKind> kind, Timestamp now) {
  std::size_t ended = 0;
  for (HeadFault& fault : faults_) {
    if ((id != 0 && fault.id != id) || (kind && fault.spec.kind != *kind)) continue;
    if (fault.over(now)) continue;
    fault.ended = true;
    ++ended;
  }
  forget_past_faults(now);
  return ended;
}

}  // namespace cellmirror::sim
