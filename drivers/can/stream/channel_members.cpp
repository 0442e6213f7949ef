#include "drivers/can/stream/channel_members.hpp"

#include <algorithm>
#include <utility>

#include "drivers/can/canopen/earlier_due.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {

void ChannelMembers::add(ChannelMember& member, Timestamp now) {
  auto place = std::ranges::find(entries_, nullptr, &Entry::member);
  if (place == entries_.end()) place = entries_.insert(entries_.end(), Entry());
  member.number_ = static_cast<std::uint16_t>(place - entries_.begin());
  *place = {.member = &member, .due = {}, .revision = 0, .called = true};
  rebuild();
  member.start(now);
  look_after_calls();
}

void ChannelMembers::remove(ChannelMember& member) {
  const auto place = std::ranges::find(entries_, &member, &Entry::member);
  CELLMIRROR_EXPECTS(place != entries_.end());
  *place = {};
  rebuild();
}

void ChannelMembers::restart(Timestamp now) {
  for (Entry& entry : entries_) {
    if (entry.member == nullptr) continue;
    entry.member->start(now);
    entry.called = true;
  }
  look_after_calls();
}

void ChannelMembers::receive(const CanFrame& frame, Timestamp now) {
  const std::span<const CanListener> listeners = routes_.of(frame);
  together_ = listeners.size() > 1;
  for (const CanListener listener : listeners) call(listener, frame, now);
  if (std::exchange(together_, false)) send_together();
  if (!listeners.empty()) look_after_calls();
}

void ChannelMembers::call(CanListener listener, const CanFrame& frame, Timestamp now) {
  Entry& entry = entries_[listener.member];
  entry.member->protocol().receive(frame, now, listener.node);
  entry.called = true;
}

void ChannelMembers::deliver_waiting() {
  if (waiting_.empty()) return;
  std::swap(waiting_, delivered_);
  for (const auto& [sender, frame, time] : delivered_) {
    for (const CanListener listener : routes_.of(frame)) {
      if (listener != sender) call(listener, frame, time);
    }
  }
  delivered_.clear();
  look_after_calls();
}

Timestamp ChannelMembers::next_due() const {
  Timestamp due;
  for (const Entry& entry : entries_) due = earlier_due(due, entry.due);
  return due;
}

void ChannelMembers::advance_next(Timestamp now) {
  const Timestamp due = next_due();
  if (!due.known() || due > now) return;
  const auto next = std::ranges::find(entries_, due, &Entry::due);
  next->member->protocol().advance(now);
  next->called = true;
  look_after_calls();
}

void ChannelMembers::look_after_calls() {
  bool changed = false;
  for (Entry& entry : entries_) {
    if (!entry.called || entry.member == nullptr) continue;
    const CanProtocol& protocol = entry.member->protocol();
    entry.due = protocol.next_due();
    const std::uint64_t revision = protocol.routes_revision();
    changed = changed || std::exchange(entry.revision, revision) != revision;
  }
  if (changed) rebuild();
}

void ChannelMembers::rebuild() {
  routes_.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].member != nullptr)
      entries_[i].member->protocol().add_routes(static_cast<std::uint16_t>(i), routes_);
  }
  routes_.build();
}

void ChannelMembers::publish() {
  for (Entry& entry : entries_) {
    if (std::exchange(entry.called, false) && entry.member != nullptr) entry.member->publish();
  }
}

void ChannelMembers::keep_error(const std::string& text) {
  for (const Entry& entry : entries_) {
    if (entry.member != nullptr) entry.member->keep_error(text);
  }
}

void ChannelMembers::send_from(const ChannelMember& member, std::size_t node, const CanFrame& frame) {
  const CanListener sender{member.number_, static_cast<std::uint16_t>(node)};
  if (!together_) return sent({sender, frame}, channel_->send(frame));
  outgoing_.push_back({sender, frame});
  if (outgoing_.size() == kTogether) send_together();
}

void ChannelMembers::send_together() {
  if (outgoing_.empty()) return;
  std::array<CanFrame, kTogether> frames;
  std::array<bool, kTogether> taken{};
  std::ranges::transform(outgoing_, frames.begin(), &Sent::frame);
  channel_->send_all(std::span(frames).first(outgoing_.size()), std::span(taken).first(outgoing_.size()));
  for (std::size_t i = 0; i < outgoing_.size(); ++i) sent(outgoing_[i], taken.at(i));
  outgoing_.clear();
}

void ChannelMembers::sent(const Sent& sent, bool taken) {
  if (!taken) return entries_[sent.sender.member].member->count_refused();
  const std::span<const CanListener> listeners = routes_.of(sent.frame);
  const bool heard = std::ranges::any_of(listeners, [&](CanListener other) { return other != sent.sender; });
  if (!heard) return;
  if (waiting_.size() == kWaiting) {
    ++dropped_;
    return;
  }
  waiting_.push_back({sent.sender, sent.frame, clock_->now()});
}

}  // namespace cellmirror::can
