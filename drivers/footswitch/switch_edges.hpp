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
  Timestamp time;      // first reading with the changed bit
  Timestamp not_told;  // the reading before that one: bounds the delay of the report
};

// A change counts at once where the bit was quiet for `debounce` before it. Further changes are bounces until the bit
// has been quiet for `debounce`; then its state counts, and is reported if it differs from the last reported one. So
// the reported changes of an input alternate, and its final state is reported at most `debounce` after it occurred.
// Inputs begin in the state of the first reading, without a change.
class SwitchEdges {
 public:
  SwitchEdges(std::size_t bytes, Nanoseconds debounce);
  // Appends the changes, lower inputs first. `bytes`: a copy of the buffer; what is shorter than the buffer leaves the
  // rest as it was. `now` never goes back. Room for 16 changes a byte keeps `edges` from allocating.
  void look(std::span<const std::uint8_t> bytes, Timestamp now, std::vector<SwitchEdge>& edges);
  [[nodiscard]] std::uint64_t bounces() const { return bounces_; }
  // Last reported states; bit 0 of the first byte is input 1.
  [[nodiscard]] std::span<const std::uint8_t> reported() const { return reported_; }

 private:
  void read_input(std::size_t byte, unsigned bit, bool raw, Timestamp now, std::vector<SwitchEdge>& edges);
  void report(std::size_t byte, unsigned bit, bool on, Timestamp time, std::vector<SwitchEdge>& edges);

  std::vector<std::uint8_t> seen_;      // as of the last reading
  std::vector<std::uint8_t> reported_;  // what counts
  std::vector<std::uint8_t> settling_;  // changed within the last `debounce`
  std::vector<Timestamp> changed_at_;   // of each input
  Nanoseconds debounce_;
  Timestamp last_look_;
  std::uint64_t bounces_ = 0;
  bool started_ = false;
};

}  // namespace cellmirror::footswitch
