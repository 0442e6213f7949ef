// Whether a device's samples may move an instrument and be answered with a force.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/haptic_state.hpp"

namespace cellmirror::haptics {

struct SampleLimits {
  bool uses_pose = true;  // the orientation has to be one
  Nanoseconds stale_after{};
  double max_speed = 0;  // m/s
};

struct Verdict {
  HapticFault fault = HapticFault::none;
  bool fresh = false;  // sample() is another one than before, and good
};

// Checks counters, ages and differences without knowledge of the instrument. Continues while a fault is latched, to
// detect whether the cause persists.
class SampleValidator {
 public:
  void restart(Timestamp now) CELL_RT;

  // What port.read() gave in this tick.
  Verdict validate(HapticRead read, const HapticSample& sample, Timestamp now, const SampleLimits& settings) CELL_RT;
  // The position (m) of the fresh sample if the device's own position does not move: `jump` if no hand can get there
  // from the last one in that time.
  HapticFault moved_to(const Eigen::Vector3d& p, const SampleLimits& settings) CELL_RT;
  // Forgets the last place, after its meaning has changed.
  void forget_place() CELL_RT { place_known_ = false; }

  [[nodiscard]] bool seen() const CELL_RT { return seen_; }                   // a good sample was ever there
  [[nodiscard]] const HapticSample& sample() const CELL_RT { return last_; }  // the last good one
  [[nodiscard]] Timestamp received() const CELL_RT { return received_; }
  [[nodiscard]] std::uint64_t samples() const CELL_RT { return samples_; }
  [[nodiscard]] std::uint64_t skipped() const CELL_RT { return skipped_; }
  [[nodiscard]] std::uint64_t torn() const CELL_RT { return torn_; }

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(seen_, place_known_, tearing_, last_, place_, place_time_, received_, count_, writes_, writer_,
            writer_known_, samples_, skipped_, torn_);
  }

 private:
  Verdict validate_new(const HapticSample& sample, Timestamp now, const SampleLimits& settings) CELL_RT;
  [[nodiscard]] bool has_other_writer(const HapticSample& sample) const CELL_RT;
  [[nodiscard]] bool old(Timestamp now, const SampleLimits& settings) const CELL_RT;
  void take(const HapticSample& sample, Timestamp now) CELL_RT;

  bool seen_ = false;
  bool place_known_ = false;
  bool tearing_ = false;
  HapticSample last_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Timestamp place_time_;
  Timestamp received_;        // when the count last increased
  std::uint64_t count_ = 0;   // last sequence, of good samples and of bad ones
  std::uint64_t writes_ = 0;  // likewise
  std::uint32_t writer_ = 0;  // likewise
  bool writer_known_ = false;
  std::uint64_t samples_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t torn_ = 0;
};

}  // namespace cellmirror::haptics
