#include "sim_devices/base/segment_seeker.hpp"

namespace cellmirror::sim {
namespace {

constexpr Nanoseconds kBetweenLooks{20'000'000};

}  // namespace

bool SegmentSeeker::look(Timestamp now) {
  if (now < next_look_) return segment_.has_value();
  next_look_ = now + kBetweenLooks;
  if (segment_ && segment_->removed()) segment_.reset();
  if (segment_) return true;
  auto attached = AttachedSegment::attach(key_, bytes_, read_only_);
  if (!attached) {
    reason_ = attached.error().text();
    return false;
  }
  reason_.clear();
  segment_.emplace(std::move(*attached));
  ++attachments_;
  return true;
}

}  // namespace cellmirror::sim
