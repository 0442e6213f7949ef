#include "app/wall/wall_inbox.hpp"

#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kBesides = 512;  // bytes that a message takes beyond its text, about
constexpr Nanoseconds kForgottenAfter{10'000'000'000};
constexpr std::size_t kLongestReason = 200;

}  // namespace

WallInbox::Refused* WallInbox::refused_of(std::string_view sender) {
  if (const auto found = waiting_.refused.find(sender); found != waiting_.refused.end()) return &found->second;
  if (waiting_.refused.size() >= kMostWallSenders) return nullptr;
  return &waiting_.refused[std::string(sender)];
}

bool WallInbox::admits(const std::string& sender, Timestamp now) {
  auto found = senders_.find(sender);
  if (found == senders_.end()) {
    if (senders_.size() >= kMostWallSenders)
      std::erase_if(senders_, [now](const auto& entry) { return now - entry.second.last > kForgottenAfter; });
    if (senders_.size() >= kMostWallSenders) {
      ++waiting_.left_out;
      return false;
    }
    found = senders_.emplace(sender, Sender{}).first;
  }
  found->second.last = now;
  const bool room =
      bytes_ < kMostWaitingBytes && waiting_.messages.size() < kMostWaitingMessages && found->second.limit.allows(now);
  if (room) return true;
  if (Refused* refused = refused_of(sender)) ++refused->dropped;
  return false;
}

void WallInbox::received(WallMessage message) {
  const std::scoped_lock lock(mutex_);
  if (!admits(message.sender, message.receive_time)) return;
  bytes_ += message.bytes + kBesides;
  waiting_.messages.push_back(std::move(message));
}

void WallInbox::rejected(std::string_view sender, const std::string& why) {
  const std::scoped_lock lock(mutex_);
  Refused* refused = refused_of(sender);
  if (refused == nullptr) {
    ++waiting_.left_out;
    return;
  }
  ++refused->rejected;
  if (refused->rejected == 1) refused->why = printable(why, kLongestReason);
}

void WallInbox::gone(std::string_view sender) {
  const std::scoped_lock lock(mutex_);
  if (waiting_.gone.size() < kMostWaitingMessages) waiting_.gone.emplace_back(sender);
}

WallInbox::Taken WallInbox::take() {
  const std::scoped_lock lock(mutex_);
  bytes_ = 0;
  return std::exchange(waiting_, {});
}

}  // namespace cellmirror::app
