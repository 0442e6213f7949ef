#include "drivers/mqtt/outbox.hpp"

#include <ranges>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::mqtt {

void Outbox::Line::push_back(Outgoing message) {
  bytes += message.bytes();
  messages.push_back(std::move(message));
}

void Outbox::Line::push_front(Outgoing message) {
  bytes += message.bytes();
  messages.push_front(std::move(message));
}

Outgoing Outbox::Line::pop_front() {
  Outgoing first = std::move(messages.front());
  messages.pop_front();
  bytes -= first.bytes();
  return first;
}

std::uint64_t Outbox::Line::trim() {
  std::uint64_t count = 0;
  for (; messages.size() > most || (bytes > kMostBytes && !messages.empty()); ++count) static_cast<void>(pop_front());
  return count;
}

Outbox::Line& Outbox::line(Outgoing::Kind kind) {
  CELLMIRROR_EXPECTS(kind != Outgoing::Kind::other && kind != Outgoing::Kind::retained);
  if (kind == Outgoing::Kind::reply) return replies_;
  return kind == Outgoing::Kind::event ? events_ : joint_states_;
}

std::uint64_t& Outbox::dropped(Outgoing::Kind kind) {
  if (kind == Outgoing::Kind::reply) return counters_.replies_dropped;
  return kind == Outgoing::Kind::event ? counters_.events_dropped : counters_.joint_states_dropped;
}

void Outbox::put(Outgoing message) {
  const Outgoing::Kind kind = message.kind;
  if (kind == Outgoing::Kind::retained) {
    const auto [place, is_new] = retained_.try_emplace(message.topic);
    if (!is_new) ++counters_.replaced;
    place->second = std::move(message);
    return;
  }
  Line& to = line(kind);
  to.push_back(std::move(message));
  dropped(kind) += to.trim();
}

std::optional<Outgoing> Outbox::take() {
  if (!retained_.empty()) {
    auto first = retained_.extract(retained_.begin());
    return std::move(first.mapped());
  }
  for (Line* from : {&replies_, &events_, &joint_states_}) {
    if (!from->messages.empty()) return from->pop_front();
  }
  return std::nullopt;
}

void Outbox::give_back(std::vector<Outgoing> unconfirmed) {
  for (Outgoing& message : unconfirmed | std::views::reverse) {
    switch (message.kind) {
      case Outgoing::Kind::retained:
        retained_.try_emplace(message.topic, message);
        break;
      case Outgoing::Kind::reply:
      case Outgoing::Kind::event:
        line(message.kind).push_front(std::move(message));
        break;
      case Outgoing::Kind::joint_states:
        ++counters_.joint_states_dropped;
        break;
      case Outgoing::Kind::other:
        break;
    }
  }
  counters_.replies_dropped += replies_.trim();
  counters_.events_dropped += events_.trim();
}

std::size_t Outbox::size() const {
  return retained_.size() + replies_.messages.size() + events_.messages.size() + joint_states_.messages.size();
}

std::size_t Outbox::bytes() const {
  std::size_t sum = replies_.bytes + events_.bytes + joint_states_.bytes;
  for (const auto& [topic, message] : retained_) sum += message.bytes();
  return sum;
}

}  // namespace cellmirror::mqtt
