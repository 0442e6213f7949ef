// The thread that gives summaries of the cell to control rooms.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <thread>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/cell_summary.hpp"
#include "rt_core/ports/summary_output.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

// When a summary is sent: twice a second, and at once where it tells something new, at most ten times a second. Pure.
class SummaryPace {
 public:
  static constexpr Nanoseconds kRegular{500'000'000};
  static constexpr Nanoseconds kShortest{100'000'000};

  // Whether `next` is due at `now`, as ipc/wire's has_news() has it. What was held back is found again at the next
  // look.
  [[nodiscard]] bool due(const CellSummary& next, Timestamp now);

 private:
  CellSummary last_;
  Timestamp sent_;
};

class SummaryPublisher {
 public:
  static constexpr Nanoseconds kLookEvery{50'000'000};
  using Look = std::function<CellSummary()>;

  // `look` is called by the publisher's thread until its end; `clock` outlives it. The machine's clock: a recording
  // that is played stands still, its summaries do not.
  SummaryPublisher(std::vector<std::unique_ptr<SummaryOutput>> outputs, Look look, const Clock& clock);
  ~SummaryPublisher();
  SummaryPublisher(const SummaryPublisher&) = delete;
  SummaryPublisher& operator=(const SummaryPublisher&) = delete;

  [[nodiscard]] const std::vector<std::unique_ptr<SummaryOutput>>& outputs() const { return outputs_; }

 private:
  void loop(const std::stop_token& stop);

  std::vector<std::unique_ptr<SummaryOutput>> outputs_;
  Look look_;
  const Clock& clock_;
  SummaryPace pace_;
  std::uint64_t sequence_ = 0;
  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
