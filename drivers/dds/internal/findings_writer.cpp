#include "drivers/dds/internal/findings_writer.hpp"

#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

namespace {

constexpr Nanoseconds kBetweenDiagnostics{1'000'000'000};  // as ROS 2's diagnostics go; at once where the level changes
constexpr Nanoseconds kBetweenMarkers{100'000'000};        // for eyes
constexpr CountingWriter::Options kForEyes{8, true};
constexpr std::size_t kMaxRangeTopics = 256;

Result<std::unique_ptr<CountingWriter>> make_unless_off(const std::shared_ptr<Participant>& participant,
                                                        const std::string& topic, std::string_view type) {
  if (topic.empty()) return nullptr;
  return CountingWriter::make(participant, topic, type, kForEyes);
}

// Whether the time has come; takes note of it.
bool is_due(Timestamp now, Timestamp& last, Nanoseconds period) {
  if (last.known() && now - last < period) return false;
  last = now;
  return true;
}

}  // namespace

Result<std::unique_ptr<FindingsWriter>> FindingsWriter::make(const std::shared_ptr<Participant>& participant,
                                                             const DdsOutputConfig& config,
                                                             CountingWriter::Options range_options) {
  std::unique_ptr<FindingsWriter> made(new FindingsWriter(participant, config.range_topic_prefix, range_options));
  auto diagnostics = make_unless_off(participant, config.diagnostics_topic, kDiagnosticArrayType);
  if (!diagnostics) return std::unexpected(diagnostics.error());
  auto markers = make_unless_off(participant, config.markers_topic, kMarkerArrayType);
  if (!markers) return std::unexpected(markers.error());
  made->diagnostics_ = std::move(*diagnostics);
  made->markers_ = std::move(*markers);
  return made;
}

FindingsWriter::FindingsWriter(std::shared_ptr<Participant> participant, std::string range_prefix,
                               CountingWriter::Options range_options)
    : participant_(std::move(participant)), range_prefix_(std::move(range_prefix)), range_options_(range_options) {}

void FindingsWriter::publish_proximity(const ProximityState& state) {
  const Timestamp now = clock_.now();
  if (diagnostics_ != nullptr) publish_diagnostics(state, now);
  if (markers_ == nullptr || !is_due(now, proximity_drawn_, kBetweenMarkers)) return;
  fill_proximity_markers(ros_time(to_wall_clock_ns(state.posture_time)), state, marker_array_);
  publish_markers(shown_proximity_);
}

void FindingsWriter::publish_diagnostics(const ProximityState& state, Timestamp now) {
  const DiagnosticLevel level = collision_level(state, now);
  if (level == last_level_ && now - diagnosed_ < kBetweenDiagnostics) return;
  last_level_ = level;
  diagnosed_ = now;
  diagnostic_array_.header.stamp = ros_time(to_wall_clock_ns(now));
  diagnostic_array_.status.resize(1);
  diagnostic_array_.status[0] = collision_status(state, now);
  encode(diagnostic_array_, diagnostics_->payload());
  diagnostics_->write();
}

void FindingsWriter::publish_markers(ShownMarkers& shown) {
  shown.update(marker_array_);
  if (marker_array_.markers.empty()) return;
  encode(marker_array_, markers_->payload());
  markers_->write();
}

CountingWriter* FindingsWriter::range_writer(const std::string& id) {
  if (const auto known = ranges_.find(id); known != ranges_.end()) return known->second.get();
  if (ranges_.size() >= kMaxRangeTopics) return nullptr;
  auto made = CountingWriter::make(participant_, range_topic(range_prefix_, id), kRangeType, range_options_);
  if (!made) log_error("dds.range-topic", "sensor {}: {}", id, made.error().text());
  const std::scoped_lock lock(ranges_mutex_);
  return ranges_.emplace(id, made ? std::move(*made) : nullptr).first->second.get();
}

void FindingsWriter::publish_ranges(std::span<const RangeReading> readings) {
  if (!range_prefix_.empty()) {
    for (const RangeReading& reading : readings) {
      CountingWriter* writer = nullptr;
      if (fill_range(ros_time(to_wall_clock_ns(reading.posture_time)), reading, range_)) {
        writer = range_writer(reading.id);
      }
      if (writer == nullptr) {
        ranges_refused_.add();
        continue;
      }
      encode(range_, writer->payload());
      writer->write();
    }
  }
  if (markers_ == nullptr || !is_due(clock_.now(), ranges_drawn_, kBetweenMarkers)) return;
  const Timestamp time = readings.empty() ? clock_.now() : readings.front().posture_time;
  fill_range_markers(ros_time(to_wall_clock_ns(time)), readings, marker_array_);
  publish_markers(shown_ranges_);
}

void FindingsWriter::add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                                  std::uint64_t& dropped) const {
  std::uint64_t ranges_sent = 0;
  std::uint64_t ranges_dropped = 0;
  std::uint64_t ranges_readers = 0;
  {
    const std::scoped_lock lock(ranges_mutex_);
    for (const auto& [id, writer] : ranges_) {
      if (writer == nullptr) continue;
      ranges_sent += writer->sent();
      ranges_dropped += writer->dropped();
      ranges_readers += writer->readers();
    }
  }
  const auto add = [&](const std::string& what, std::uint64_t its_sent, std::uint64_t its_dropped,
                       std::uint64_t readers) {
    counters.insert(counters.end(),
                    {{what + "_sent", its_sent}, {what + "_dropped", its_dropped}, {what + "_readers", readers}});
    sent += its_sent;
    dropped += its_dropped;
  };
  add("ranges", ranges_sent, ranges_dropped, ranges_readers);
  counters.emplace_back("ranges_refused", ranges_refused_.get());
  if (diagnostics_ != nullptr)
    add("diagnostics", diagnostics_->sent(), diagnostics_->dropped(), diagnostics_->readers());
  if (markers_ != nullptr) add("markers", markers_->sent(), markers_->dropped(), markers_->readers());
}

}  // namespace cellmirror::dds
