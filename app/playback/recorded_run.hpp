// A recording as the player needs it: how long it is, which robots it has, and its ticks from any time on. One thread
// at a time; not for the tick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/playback/playback_control.hpp"
#include "app/playback/played_tissue.hpp"
#include "app/playback/published_ticks.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

class RecordedRun {
 public:
  // Fails where it is no recording, has no inputs, or none that can be played.
  [[nodiscard]] static Result<std::unique_ptr<RecordedRun>> open(const std::filesystem::path& file,
                                                                 const mcap::Limits& limits = {});

  // All that can be played.
  [[nodiscard]] const PlaybackControl::Range& range() const { return range_; }
  // Log times of the file begin here, UTC.
  [[nodiscard]] std::int64_t start_ns() const {
    return static_cast<std::int64_t>(std::min<std::uint64_t>(reader_->statistics().start_time, kLatestInstant.ns));
  }
  [[nodiscard]] const mcap::Reader& reader() const { return *reader_; }
  // Of the tick that read() hands in, within that call.
  [[nodiscard]] const engine::TickState& state() { return ticks_.state(); }
  [[nodiscard]] const NamesBySlot& names() const { return ticks_.names(); }
  [[nodiscard]] std::uint64_t names_revision() const { return ticks_.names_revision(); }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }

  // Ticks from the last start state before `time` on, or from the first after it where there is none; `take` ends it.
  // Fails where the file cannot be read on, or is not sound.
  Result<void> read(Timestamp time, const PublishedTicks::Take& take);
  // As of the tick that read() hands in, once it is published.
  [[nodiscard]] PlayedTissue& tissue() { return tissue_; }
  [[nodiscard]] const PlayedTissue& tissue() const { return tissue_; }
  // All messages of another topic, in the order of the file; `take` ends it.
  Result<void> read_topic(std::string_view topic, const mcap::Reader::Take& take) {
    return reader_->read({.topics = {std::string(topic)}}, take);
  }

 private:
  RecordedRun() = default;
  Result<void> find_range();
  Result<void> find_utc(const std::string& recorded);
  // Ticks from the log time `from` on, UTC.
  Result<void> read_from(std::uint64_t from, const PublishedTicks::Take& take);
  [[nodiscard]] std::optional<Timestamp> last_tick_from(std::uint64_t from);

  std::unique_ptr<mcap::FileSource> source_;
  std::optional<mcap::Reader> reader_;
  PlaybackControl::Range range_;
  double rate_hz_ = 1000;
  PublishedTicks ticks_;
  PlayedTissue tissue_;
  std::vector<std::string> played_topics_;  // that read() needs
};

}  // namespace cellmirror::app
