#include "app/playback/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/recording/recorded_cell.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000;
// A start state comes every 10 s, and its message some time after its ticks.
constexpr std::uint64_t kBetweenStarts_ns = 11 * kSecond_ns;
constexpr std::int64_t kSameOffset_ns = 5'000'000;
constexpr int kMessagesForOffset = 20;

}  // namespace

Result<std::unique_ptr<RecordedRun>> RecordedRun::open(const std::filesystem::path& file, const mcap::Limits& limits) {
  std::unique_ptr<RecordedRun> out(new RecordedRun);
  auto source = mcap::FileSource::open(file);
  if (!source) return std::unexpected(source.error());
  out->source_ = *std::move(source);
  auto reader = mcap::Reader::open(*out->source_, limits);
  if (!reader) return fail(file.string() + ": " + reader.error().what, reader.error().remedy);
  out->reader_.emplace(*std::move(reader));
  const bool has_inputs = std::ranges::any_of(out->reader_->catalogue().channels, [](const auto& one) {
    return one.second.topic == kInputsTopic && one.second.encoding == kInputsEncoding;
  });
  if (!has_inputs)
    return fail(fmt::format("{}: the recording has no topic {}, so it cannot be played", file.string(), kInputsTopic),
                "record it without --topics, or with this one among them");
  out->played_topics_.emplace_back(kInputsTopic);
  for (const auto& [id, channel] : out->reader_->catalogue().channels)
    if (is_of_tissue(channel)) out->played_topics_.push_back(channel.topic);
  if (auto found = out->find_range(); !found)
    return fail(file.string() + ": " + found.error().what, found.error().remedy);
  if (const auto rate = parse_number(gateway_value(*out->reader_, "loop_rate_hz")); rate && *rate >= 1 && *rate <= 1e5)
    out->rate_hz_ = *rate;
  return out;
}

std::optional<Timestamp> RecordedRun::last_tick_from(std::uint64_t from) {
  std::optional<Timestamp> last;
  const mcap::Filter filter{.topics = {std::string(kInputsTopic)}, .from = from};
  static_cast<void>(reader_->read(filter, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (channel.encoding != kInputsEncoding) return true;
    static_cast<void>(for_each_record(message.data, [&](engine::InputRecord kind, ByteSpan content) {
      if (kind != engine::InputRecord::tick) return true;
      if (const auto time = time_of_tick(content); time && (!last || *time > *last)) last = time;
      return true;
    }));
    return true;
  }));
  return last;
}

Result<void> RecordedRun::find_range() {
  std::optional<Timestamp> first;
  auto read = read_from(0, [&](Timestamp time, bool /*after_gap*/) {
    first = time;
    return false;
  });
  if (!read && !first) return read;
  const std::uint64_t end = reader_->statistics().end_time;
  std::optional<Timestamp> last = last_tick_from(end - std::min(end, 2 * kSecond_ns));
  if (!last || (first && *last < *first)) last = last_tick_from(0);
  if (!first || !last || *last < *first)
    return fail("no tick of the recording can be played: it has no start state",
                "a recording has one within its first half second; record longer");
  range_ = {.from = *first, .to = *last, .utc = {}};
  return find_utc(gateway_value(*reader_, kUtcKey));
}

// The recording says it; older ones do not, and the clock of a machine may have been set since a black box began: then
// from the messages, each of which was written soon after its last tick.
Result<void> RecordedRun::find_utc(const std::string& recorded) {
  std::optional<std::int64_t> estimate;
  int messages = 0;
  const mcap::Filter filter{.topics = {std::string(kInputsTopic)}};
  auto read = reader_->read(filter, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (channel.encoding != kInputsEncoding || message.log_time >= static_cast<std::uint64_t>(kLatestInstant.ns))
      return true;
    std::optional<Timestamp> newest;
    static_cast<void>(for_each_record(message.data, [&](engine::InputRecord kind, ByteSpan content) {
      if (kind == engine::InputRecord::tick) newest = time_of_tick(content);
      return true;
    }));
    if (!newest) return true;
    const std::int64_t offset = static_cast<std::int64_t>(message.log_time) - newest->ns;
    estimate = std::min(estimate.value_or(offset), offset);
    return ++messages < kMessagesForOffset;
  });
  if (!estimate) return read ? fail("the recording has no ticks") : read;
  const auto said = parse_integer(recorded);
  const bool near = said && *said > *estimate - kSameOffset_ns && *said < *estimate + kSameOffset_ns;
  range_.utc = Nanoseconds(near ? *said : *estimate);
  return {};
}

Result<void> RecordedRun::read_from(std::uint64_t from, const PublishedTicks::Take& take) {
  ticks_.gap();
  tissue_.begin();
  std::optional<std::uint32_t> last;
  Result<void> sound;
  const mcap::Filter filter{.topics = played_topics_, .from = from};
  auto read = reader_->read(filter, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (is_of_tissue(channel)) tissue_.take(channel, message.data);
    if (channel.encoding != kInputsEncoding || channel.topic != kInputsTopic) return true;
    if (last && message.sequence != *last + 1) ticks_.gap();
    last = message.sequence;
    const auto more = ticks_.take(message.data, take);
    if (!more) sound = std::unexpected(more.error());
    return more.has_value() && *more;
  });
  return sound ? read : sound;
}

Result<void> RecordedRun::read(Timestamp time, const PublishedTicks::Take& take) {
  const auto at = static_cast<std::uint64_t>(std::max<std::int64_t>(0, (time + range_.utc).ns));
  for (std::uint64_t back = kBetweenStarts_ns;; back *= 4) {
    const std::uint64_t from = at - std::min(at, back);
    const bool from_begin = from <= reader_->statistics().start_time;
    bool first = true;
    bool too_late = false;
    auto read = read_from(from_begin ? 0 : from, [&](Timestamp of_tick, bool after_gap) {
      too_late = first && !from_begin && of_tick > time;
      first = false;
      return !too_late && take(of_tick, after_gap);
    });
    // Without a start state, or one after the time only: it may be further back.
    const bool none = first && !from_begin;
    if (!too_late && !none) return read;
  }
}

}  // namespace cellmirror::app
