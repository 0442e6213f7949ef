// The simulated device at work: once a period it reads the force, lets the hand move, and writes where it is.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim_devices/base/control_fifo.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/base/segment_seeker.hpp"
#include "sim_devices/haptic/force_reader.hpp"
#include "sim_devices/haptic/hand.hpp"
#include "sim_devices/haptic/haptic_log.hpp"
#include "sim_devices/haptic/motion_player.hpp"
#include "sim_devices/haptic/options.hpp"
#include "sim_devices/haptic/second_writer.hpp"

namespace cellmirror::sim {

// Everything but time and memory: fed by the loop, or by a test in virtual time.
class HapticDevice {
 public:
  explicit HapticDevice(const HapticOptions& options);

  // One period: moves the hand by `dt` under the answer's push and gives what the device measures then, faults of
  // values included. `since_start` counts from the first period.
  [[nodiscard]] const HapticSample& step(const HapticOutput& answer, Timestamp now, double since_start, double dt);

  [[nodiscard]] const AxisLayout& layout() const { return layout_; }
  [[nodiscard]] const Hand& hand() const { return hand_; }
  [[nodiscard]] const Coordinates& efforts() const { return efforts_; }
  [[nodiscard]] const Coordinates& measured() const { return measured_; }
  [[nodiscard]] bool done() const { return player_.done(); }
  void play(std::vector<MotionStep> steps) { player_.replace(std::move(steps)); }
  // Its window counts from now. False where there are kMaxFaults already.
  bool add_fault(HapticFaultSpec fault);
  void clear_faults();
  [[nodiscard]] std::span<const HapticFaultSpec> faults() const { return options_.faults; }
  // The fault of this kind that is in force now; null: none.
  [[nodiscard]] const HapticFaultSpec* in_force(HapticFaultKind kind) const;
  [[nodiscard]] std::uint32_t struck() const { return struck_; }  // bit a fault, in their order

 private:
  void measure(Timestamp now);

  static constexpr std::size_t kMaxFaults = 32;

  HapticOptions options_;
  AxisLayout layout_;
  Hand hand_;
  MotionPlayer player_;
  Coordinates efforts_{};
  Coordinates measured_{};
  HapticSample healthy_;  // before faults
  HapticSample sample_;
  std::optional<HapticSample> stuck_at_;
  std::uint32_t struck_ = 0;
  double since_start_ = 0;
};

class HapticLoop {
 public:
  // Not owned; null: none.
  HapticLoop(const HapticOptions& options, HapticLog* log, ControlFifo* control);

  // Returns at the end of the motion or of --for, or after a signal. False where the memory never came.
  bool run();
  [[nodiscard]] const HapticSummary& summary() const { return summary_; }

 private:
  bool wait_for_memory();
  [[nodiscard]] bool over(Timestamp now) const;
  void period(Timestamp now, double dt);
  void write(const HapticSample& sample);
  void note_faults(Timestamp now);
  void end_by_fault(bool torn);
  void wait_for_answer(Timestamp until);
  void log(Timestamp now);
  void listen(Timestamp now);
  // Why it was refused; empty if accepted.
  [[nodiscard]] std::string execute(std::string_view line);

  HapticOptions options_;
  HapticLog* log_;
  ControlFifo* control_;
  SystemClock clock_;
  HapticSummary summary_;
  HapticDevice device_;
  SegmentSeeker seeker_;
  ForceReader reader_;
  WriteTimes written_;
  SecondWriter second_;
  Nanoseconds period_;
  Timestamp started_;
  Timestamp next_listen_;
  bool quit_ = false;
  std::uint64_t sequence_ = 0;
  std::uint64_t attachments_ = 0;
  std::uint32_t noted_ = 0;  // faults in the summary
  HapticSample last_;
};

}  // namespace cellmirror::sim
