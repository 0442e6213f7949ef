// Binary inputs (foot switches): bits of a byte buffer, debounced, as a row of changes. No I/O, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror::footswitch {

struct SwitchEdge {
  std::uint32_t input = 0;  // from 1, as in BININP1: bit 0 of the first byte
  bool on = false;
  Timestamp time;  // when the bit changed, before debouncing
};

// A change counts at once when the bit was quiet for `debounce` before it; further changes within `debounce` are
// bounces: when that time is over the bit's state counts, and where it is another one than the last that was told, that
// is told. Inputs are on their first state without a change.
class SwitchEdges {
 public:
  SwitchEdges(std::size_t bytes, Nanoseconds debounce);
  // Appends the changes, lower inputs first. `bytes`: a copy of the buffer.
  void look(std::span<const std::uint8_t> bytes, Timestamp now, std::vector<SwitchEdge>& edges);
  [[nodiscard]] std::uint64_t bounces() const { return bounces_; }

 private:
  struct Input {
    bool seen = false;
    bool told = false;
    Timestamp quiet_since;
  };
  std::vector<Input> inputs_;
  Nanoseconds debounce_;
  std::uint64_t bounces_ = 0;
  bool started_ = false;
};

}  // namespace cellmirror::footswitch
