#include "drivers/dds/internal/tissue_writer.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/base/log.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {

namespace {

// A message is some hundred kB, and replaces the one before.
constexpr CountingWriter::Options kOptions{.depth = 2, .counts_overwritten = true, .large = true};
constexpr std::int64_t kPeriodsShown = 4;  // that a viewer keeps what is not refreshed

Nanoseconds period_of(const DdsOutputConfig& config) {
  if (config.tissue_topic.empty() || !(config.tissue_rate_hz > 0)) return Nanoseconds(0);
  return Nanoseconds(static_cast<std::int64_t>(std::llround(1e9 / config.tissue_rate_hz)));
}

}  // namespace

TissueWriter::TissueWriter(std::shared_ptr<Participant> participant, const DdsOutputConfig& config)
    : participant_(std::move(participant)),
      topic_(config.tissue_topic),
      period_(period_of(config)),
      markers_(config.tissue_triangles, std::max(kMarkerLifetimeNs, kPeriodsShown * period_.count())) {}

void TissueWriter::publish(Timestamp time, const TissueView& view, std::span<const TissueForceArrow> forces) {
  if (period_ <= Nanoseconds(0) || refused_) return;
  if (!writer_) {
    auto made = CountingWriter::make(participant_, topic_, kMarkerArrayType, kOptions);
    if (!made) {
      refused_ = true;
      log_error("dds.tissue-topic", "{}", made.error().text());
      return;
    }
    const std::scoped_lock lock(mutex_);
    writer_ = std::move(*made);
  }
  markers_.fill(ros_time(to_wall_clock_ns(time)), view, forces, message_);
  shown_.update(message_);
  if (message_.markers.empty()) return;
  encode(message_, writer_->payload());
  writer_->write();
}

void TissueWriter::add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                                std::uint64_t& dropped) const {
  const std::scoped_lock lock(mutex_);
  if (!writer_) return;
  counters.insert(counters.end(), {{"tissue_sent", writer_->sent()},
                                   {"tissue_dropped", writer_->dropped()},
                                   {"tissue_readers", writer_->readers()}});
  sent += writer_->sent();
  dropped += writer_->dropped();
}

}  // namespace cellmirror::dds
