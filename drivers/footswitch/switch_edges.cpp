#include "drivers/footswitch/switch_edges.hpp"

#include <algorithm>

namespace cellmirror::footswitch {

namespace {

constexpr unsigned kBits = 8;

bool bit_of(std::uint8_t byte, unsigned bit) { return ((byte >> bit) & 1U) != 0; }

void set_bit(std::uint8_t& byte, unsigned bit, bool on) {
  const unsigned mask = 1U << bit;
  byte = static_cast<std::uint8_t>(on ? byte | mask : byte & ~mask);
}

}  // namespace

SwitchEdges::SwitchEdges(std::size_t bytes, Nanoseconds debounce)
    : seen_(bytes), reported_(bytes), settling_(bytes), changed_at_(bytes * kBits), debounce_(debounce) {}

void SwitchEdges::look(std::span<const std::uint8_t> bytes, Timestamp now, std::vector<SwitchEdge>& edges) {
  const std::size_t count = std::min(bytes.size(), seen_.size());
  if (!started_) {
    started_ = true;
    std::copy_n(bytes.begin(), count, seen_.begin());
    reported_ = seen_;
    last_look_ = now;
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto of_interest = static_cast<std::uint8_t>((bytes[i] ^ seen_[i]) | settling_[i]);
    if (of_interest == 0) continue;
    for (unsigned bit = 0; bit < kBits; ++bit) {
      if (bit_of(of_interest, bit)) read_input(i, bit, bit_of(bytes[i], bit), now, edges);
    }
    seen_[i] = bytes[i];
  }
  last_look_ = now;
}

void SwitchEdges::read_input(std::size_t byte, unsigned bit, bool raw, Timestamp now, std::vector<SwitchEdge>& edges) {
  const bool seen = bit_of(seen_[byte], bit);
  const bool reported = bit_of(reported_[byte], bit);
  Timestamp& changed_at = changed_at_[byte * kBits + bit];
  if (bit_of(settling_[byte], bit)) {
    if (now - changed_at < debounce_) {
      if (raw == seen) return;
      ++bounces_;
      changed_at = now;
      return;
    }
    set_bit(settling_[byte], bit, false);
    if (seen != reported) report(byte, bit, seen, changed_at, edges);
  }
  if (raw == seen) return;
  changed_at = now;
  set_bit(settling_[byte], bit, debounce_.count() > 0);
  report(byte, bit, raw, now, edges);
}

void SwitchEdges::report(std::size_t byte, unsigned bit, bool on, Timestamp time, std::vector<SwitchEdge>& edges) {
  set_bit(reported_[byte], bit, on);
  edges.push_back({static_cast<std::uint32_t>(byte * kBits + bit + 1), on, time, last_look_});
}

}  // namespace cellmirror::footswitch
