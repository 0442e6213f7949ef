#include "app/io/summary_publisher.hpp"

#include <string>
#include <utility>

#include "ipc/wire/cell_summary_text.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

bool SummaryPace::due(const CellSummary& next, Timestamp now) {
  if (sent_.known()) {
    const Nanoseconds since = now - sent_;
    if (since < kShortest) return false;
    if (since < kRegular && !has_news(last_, next)) return false;
  }
  last_ = next;
  sent_ = now;
  return true;
}

SummaryPublisher::SummaryPublisher(std::vector<std::unique_ptr<SummaryOutput>> outputs, Look look, const Clock& clock)
    : outputs_(std::move(outputs)), look_(std::move(look)), clock_(clock) {
  if (!outputs_.empty()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
}

SummaryPublisher::~SummaryPublisher() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

void SummaryPublisher::loop(const std::stop_token& stop) {
  set_thread_name("summary");
  while (!stop.stop_requested()) {
    CellSummary summary = look_();
    if (pace_.due(summary, clock_.now())) {
      summary.sequence = ++sequence_;
      const std::string text = cell_summary_text(summary);
      for (const auto& output : outputs_) output->publish(summary, text);
    }
    wake_.wait(kLookEvery);
  }
}

}  // namespace cellmirror::app
