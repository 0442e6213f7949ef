// Where summaries of the cell go.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/ports/cell_summary.hpp"

namespace cellmirror {

// One calling thread. Never blocks; what cannot be delivered is dropped and counted.
class SummaryOutput {
 public:
  virtual ~SummaryOutput() = default;
  // `text`: the summary as a JSON document (ipc/wire/cell_summary_text.hpp).
  virtual void publish(const CellSummary& summary, std::string_view text) = 0;
  // {"sent", n}, {"dropped", n}, ...; any thread.
  [[nodiscard]] virtual std::vector<std::pair<std::string, std::uint64_t>> counters() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  // Why it reaches nobody, with the remedy; empty: nothing is known against it. Any thread.
  [[nodiscard]] virtual std::string problem() const { return {}; }
};

}  // namespace cellmirror
