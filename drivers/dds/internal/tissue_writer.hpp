// Writes deformable objects and the forces of instruments on them to their DDS topic.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "drivers/dds/findings_markers.hpp"
#include "drivers/dds/internal/counting_writer.hpp"
#include "drivers/dds/tissue_markers.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror::dds {

// One calling thread, but for add_counters(). The topic is made with the first shapes: cells without tissue have none.
class TissueWriter {
 public:
  TissueWriter(std::shared_ptr<Participant> participant, const DdsOutputConfig& config);

  // 0: not wanted. The topic is there from the first shapes on; then it is wanted while it has readers.
  [[nodiscard]] Nanoseconds period() const {
    return refused_ || (writer_ && writer_->readers() == 0) ? Nanoseconds(0) : period_;
  }
  void publish(Timestamp time, const TissueView& view, std::span<const TissueForceArrow> forces);
  // Any thread. Adds to the sums, too; nothing before the first shapes.
  void add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                    std::uint64_t& dropped) const;

 private:
  std::shared_ptr<Participant> participant_;
  std::string topic_;
  Nanoseconds period_;
  TissueMarkers markers_;
  mutable std::mutex mutex_;  // the writer is made while another thread counts
  std::unique_ptr<CountingWriter> writer_;
  bool refused_ = false;  // DDS refused the topic
  ShownMarkers shown_;
  MarkerArray message_;  // reused
};

}  // namespace cellmirror::dds
