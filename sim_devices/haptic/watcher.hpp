// Read only: records every answer of the gateway, with the content of the device's section at that time.
#pragma once

#include "sim_devices/base/segment_seeker.hpp"
#include "sim_devices/haptic/force_reader.hpp"
#include "sim_devices/haptic/haptic_log.hpp"
#include "sim_devices/haptic/options.hpp"

namespace cellmirror::sim {

class HapticWatcher {
 public:
  HapticWatcher(const HapticOptions& options, HapticLog* log);
  // Until --for is over or a signal comes.
  void run();
  [[nodiscard]] const HapticSummary& summary() const { return summary_; }

 private:
  void look(Timestamp now);

  HapticOptions options_;
  HapticLog* log_;
  SystemClock clock_;
  HapticSummary summary_;
  AxisLayout layout_;
  SegmentSeeker seeker_;
  ForceReader reader_;
  WriteTimes nothing_written_;
  std::uint64_t device_lock_ = 0;
  std::uint64_t attachments_ = 0;
  HapticSample sample_;
};

}  // namespace cellmirror::sim
