// Writes what touches, what is near and what sensors read to its DDS topics.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/findings_markers.hpp"
#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/proximity_diagnostics.hpp"
#include "drivers/dds/sensor_ranges.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

// One calling thread, but for add_counters().
class FindingsWriter {
 public:
  // Makes the writers of diagnostics and markers; that of a sensor is made when it is read for the first time.
  [[nodiscard]] static Result<std::unique_ptr<FindingsWriter>> make(const std::shared_ptr<Participant>& participant,
                                                                    const DdsOutputConfig& config,
                                                                    CountingWriter::Options range_options);

  void publish_proximity(const ProximityState& state);
  void publish_ranges(std::span<const RangeReading> readings);
  // Any thread. Adds to the sums, too.
  void add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                    std::uint64_t& dropped) const;

 private:
  FindingsWriter(std::shared_ptr<Participant> participant, std::string range_prefix,
                 CountingWriter::Options range_options);
  void publish_diagnostics(const ProximityState& state, Timestamp now);
  void publish_markers(ShownMarkers& shown);
  [[nodiscard]] CountingWriter* range_writer(const std::string& id);

  std::shared_ptr<Participant> participant_;
  std::string range_prefix_;
  CountingWriter::Options range_options_;
  std::unique_ptr<CountingWriter> diagnostics_;                    // null where the topic is switched off
  std::unique_ptr<CountingWriter> markers_;                        // likewise
  mutable std::mutex ranges_mutex_;                                // the map grows while another thread counts
  std::map<std::string, std::unique_ptr<CountingWriter>> ranges_;  // by id; null where DDS refused the topic
  Counter ranges_refused_;

  SystemClock clock_;
  std::optional<DiagnosticLevel> last_level_;
  Timestamp diagnosed_;
  Timestamp proximity_drawn_;
  Timestamp ranges_drawn_;
  ShownMarkers shown_proximity_;
  ShownMarkers shown_ranges_;
  // Reused.
  Range range_;
  DiagnosticArray diagnostic_array_;
  MarkerArray marker_array_;
};

}  // namespace cellmirror::dds
