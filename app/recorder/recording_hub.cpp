#include "app/recorder/recording_hub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace cellmirror::app {

std::pair<RecordingHub::Shared, RecordingHub::Shared> RecordingHub::both() const {
  const std::scoped_lock lock(mutex_);
  return {file_, ring_};
}

Result<void> RecordingHub::start_file(RecordingOptions options) {
  if (const Shared before = both().first; goes_on(before)) {
    return fail(fmt::format("a recording is running already: {}", before->report().file),
                "end it first (Ctrl-C in its cellmirror record)");
  }
  auto made = Recording::start(std::move(options), clock_);
  if (!made) return std::unexpected(made.error());
  Shared old = *std::move(made);
  const std::scoped_lock lock(mutex_);
  std::swap(file_, old);  // the old one has ended; it is released after the lock
  ++starts_;
  return {};
}

Result<void> RecordingHub::start_ring(RecordingOptions options) {
  auto made = Recording::start(std::move(options), clock_);
  if (!made) return std::unexpected(made.error());
  Shared old = *std::move(made);
  {
    const std::scoped_lock lock(mutex_);
    std::swap(ring_, old);
    ++starts_;
  }
  return {};
}

void RecordingHub::set_ring_options(RecordingOptions options) {
  const std::scoped_lock lock(mutex_);
  ring_options_ = std::move(options);
}

bool RecordingHub::end_file() {
  const Shared file = both().first;
  if (!file) return false;
  file->end();
  return true;
}

bool RecordingHub::renew_file() {
  const Shared file = both().first;
  if (!file) return false;
  file->renew();
  return true;
}

Result<void> RecordingHub::switch_ring(bool on) {
  std::optional<RecordingOptions> options;
  {
    const std::scoped_lock lock(mutex_);
    options = ring_options_;
  }
  if (!options) return fail("this cell has no black box", "add a table [record] to the cell file (docs/recording.md)");
  const Shared ring = both().second;
  if (!on) {
    if (ring) ring->end();
    return {};
  }
  if (goes_on(ring)) return {};
  return start_ring(*std::move(options));
}

Result<void> RecordingHub::keep_ring() {
  const Shared ring = both().second;
  if (ring && ring->keep()) return {};
  return fail("no black box is being recorded, so nothing is kept",
              "switch it on with RECORD ON; the cell file needs a table [record]");
}

void RecordingHub::put(const TopicPtr& topic, std::int64_t publish_time_ns, mcap::View data) const {
  const auto [file, ring] = both();
  if (!file && !ring && !live_) return;
  const std::int64_t now = to_wall_clock_ns(clock_.now());
  if (file) file->put(topic, now, publish_time_ns, data);
  if (ring) ring->put(topic, now, publish_time_ns, data);
  if (live_) live_->put(topic, now, publish_time_ns, data);
}

void RecordingHub::count_missed(const TopicPtr& topic, std::uint64_t messages) const {
  const auto [file, ring] = both();
  if (file) file->count_missed(topic, messages);
  if (ring) ring->count_missed(topic, messages);
  if (live_) live_->count_missed(topic, messages);
}

bool RecordingHub::wants(const Topic& topic) const {
  // First: so it gets to know all topics.
  const bool live = live_ && live_->wants(topic);
  const auto [file, ring] = both();
  return live || (goes_on(file) && file->wants(topic)) || (goes_on(ring) && ring->wants(topic));
}

std::vector<WantedPicture> RecordingHub::pictures() const {
  const auto [file, ring] = both();
  std::vector<WantedPicture> out;
  for (const Shared& one : {file, ring}) {
    if (!goes_on(one)) continue;
    for (const WantedPicture& picture : one->pictures()) {
      const auto known = std::ranges::find(out, picture.view, &WantedPicture::view);
      if (known == out.end()) {
        out.push_back(picture);
      } else {
        known->rate_hz = std::max(known->rate_hz, picture.rate_hz);
      }
    }
  }
  return out;
}

double RecordingHub::rate_hz() const {
  const auto [file, ring] = both();
  return std::max(
      {goes_on(file) ? file->rate_hz() : 0.0, goes_on(ring) ? ring->rate_hz() : 0.0, live_ ? live_->rate_hz() : 0.0});
}

double RecordingHub::tissue_rate_hz() const {
  const auto [file, ring] = both();
  const double live = live_ && live_->rate_hz() > 0 ? kUsualTissueRate_hz : 0.0;
  return std::max({goes_on(file) ? file->tissue_rate_hz() : 0.0, goes_on(ring) ? ring->tissue_rate_hz() : 0.0, live});
}

std::vector<RecordingReport> RecordingHub::reports() const {
  const auto [file, ring] = both();
  std::vector<RecordingReport> out;
  if (file) out.push_back(file->report());
  if (ring) out.push_back(ring->report());
  return out;
}

std::uint64_t RecordingHub::files_begun() const {
  std::uint64_t sum = 0;
  for (const RecordingReport& report : reports()) sum += report.files;
  const std::scoped_lock lock(mutex_);
  // One that ended and the one after it may have as many files.
  return sum + (starts_ << 32U);
}

std::optional<RecordingReport> RecordingHub::file_report() const {
  const Shared file = both().first;
  if (!file) return std::nullopt;
  return file->report();
}

std::string RecordingHub::problem() const {
  for (const RecordingReport& report : reports()) {
    if (!report.problem.empty() && !report.ended) return "the recording loses messages: " + report.problem;
    if (report.ended && report.ring && !report.why.empty()) return "the black box has ended: " + report.why;
  }
  return {};
}

void RecordingHub::close() {
  Shared file;
  Shared ring;
  {
    const std::scoped_lock lock(mutex_);
    file = std::move(file_);
    ring = std::move(ring_);
  }
  if (file) file->end();
  if (ring) ring->end();
}

}  // namespace cellmirror::app
