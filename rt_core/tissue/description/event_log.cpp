#include "rt_core/tissue/description/event_log.hpp"

#include <algorithm>
#include <utility>

namespace cellmirror::tissue {

EventLog::EventLog() {
  of_step_.reserve(kInStep);
  kept_.reserve(kKept);
}

void EventLog::begin_step(Timestamp time, std::uint64_t step) {
  time_ = time;
  step_ = step;
  of_step_.erase(of_step_.begin(), of_step_.begin() + static_cast<std::ptrdiff_t>(ended_));
  ended_ = 0;
}

void EventLog::add(TissueEventKind kind, const Source& source, const Eigen::Vector3d& at, double value) {
  TissueEvent event;
  event.kind = kind;
  push(event, source, at, value);
}

void EventLog::add_limit(TissueLimit limit, const Source& source, const Eigen::Vector3d& at, double value) {
  const auto same = std::ranges::find_if(reported_, [&](const Reported& one) {
    return one.step != 0 && one.limit == limit && one.instrument == source.instrument && one.object == source.object;
  });
  if (same != reported_.end()) {
    if (step_ - same->step < kStepsBetweenLimits) return;
    same->step = step_;
  } else {
    reported_.at(next_reported_) = {limit, source.instrument, source.object, step_};
    next_reported_ = (next_reported_ + 1) % reported_.size();
  }
  TissueEvent event;
  event.kind = TissueEventKind::limit;
  event.limit = limit;
  push(event, source, at, value);
}

void EventLog::push(TissueEvent event, const Source& source, const Eigen::Vector3d& at, double value) {
  event.number = ++number_;
  event.time = time_;
  event.instrument = static_cast<std::int16_t>(source.instrument);
  event.object = static_cast<std::int16_t>(source.object);
  event.at = at;
  event.value = value;
  const std::size_t length = std::min(source.part.size(), event.part.size() - 1);
  std::copy_n(source.part.begin(), length, event.part.begin());
  ++counts_.at(std::to_underlying(event.kind));
  if (of_step_.size() < kInStep) of_step_.push_back(event);
  if (kept_.size() < kKept) {
    kept_.push_back(event);
  } else {
    kept_[oldest_] = event;
    oldest_ = (oldest_ + 1) % kKept;
  }
}

void EventLog::last(std::vector<TissueEvent>& events) const {
  events.clear();
  for (std::size_t i = 0; i < kept_.size(); ++i) events.push_back(kept_[(oldest_ + i) % kept_.size()]);
}

}  // namespace cellmirror::tissue
