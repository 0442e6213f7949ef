#include "ipc/foxglove/fair_queue.hpp"

#include <algorithm>

namespace cellmirror::foxglove {

namespace {

constexpr std::uint64_t kCostOfAMessage = 64;  // bytes: heads, and what a system call costs

}  // namespace

void FairQueue::open(std::uint32_t subscription, std::size_t depth) {
  Lane& lane = lanes_[subscription];
  waiting_ -= lane.messages.size();
  lane = {};
  lane.depth = std::max<std::size_t>(1, depth);
}

void FairQueue::close(std::uint32_t subscription) {
  const auto found = lanes_.find(subscription);
  if (found == lanes_.end()) return;
  waiting_ -= found->second.messages.size();
  lanes_.erase(found);
}

std::size_t FairQueue::push(std::uint32_t subscription, std::uint64_t time_ns, const Payload& payload) {
  const auto found = lanes_.find(subscription);
  if (found == lanes_.end()) return 0;
  Lane& lane = found->second;
  if (lane.messages.empty()) lane.start = std::max(lane.start, now_);
  std::size_t dropped = 0;
  while (!lane.messages.empty() && (lane.messages.size() >= lane.depth || lane.bytes + payload->size() > kMostBytes)) {
    lane.bytes -= lane.messages.front().payload->size();
    lane.messages.pop_front();
    ++dropped;
  }
  lane.bytes += payload->size();
  lane.messages.push_back({subscription, time_ns, payload});
  lane.dropped += dropped;
  waiting_ += 1;
  waiting_ -= dropped;
  return dropped;
}

std::optional<Waiting> FairQueue::pop() {
  Lane* next = nullptr;
  for (auto& [subscription, lane] : lanes_) {
    if (!lane.messages.empty() && (next == nullptr || lane.start < next->start)) next = &lane;
  }
  if (next == nullptr) return std::nullopt;
  Waiting out = std::move(next->messages.front());
  next->messages.pop_front();
  next->bytes -= out.payload->size();
  --waiting_;
  now_ = next->start;
  next->start += out.payload->size() + kCostOfAMessage;
  return out;
}

std::uint64_t FairQueue::dropped(std::uint32_t subscription) const {
  const auto found = lanes_.find(subscription);
  return found == lanes_.end() ? 0 : found->second.dropped;
}

}  // namespace cellmirror::foxglove
