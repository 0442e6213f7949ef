#include "drivers/dds/held_replies.hpp"

namespace cellmirror::dds {

bool HeldReplies::hold(const RequestName& to, std::span<const std::byte> payload) {
  const bool room = held_.size() < kMost;
  if (!room) held_.pop_front();
  held_.push_back({to, {payload.begin(), payload.end()}});
  return room;
}

}  // namespace cellmirror::dds
