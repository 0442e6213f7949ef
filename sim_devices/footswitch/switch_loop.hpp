// Carries a plan out: each change at its time, in the memory of the gateway.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "sim_devices/base/control_fifo.hpp"
#include "sim_devices/base/segment_seeker.hpp"
#include "sim_devices/footswitch/options.hpp"

namespace cellmirror::sim {

struct FootSwitchSummary {
  double duration_s = 0;
  double waited_s = 0;
  std::uint64_t attachments = 0;
  std::uint64_t changes = 0;  // bounces not counted
  std::uint64_t bounces = 0;
  std::uint64_t left_out = 0;  // there was no memory, or no such bit in it
  double latest_us = 0;        // the latest change after its time
};
[[nodiscard]] std::string to_json(const FootSwitchSummary& summary);  // one line

class SwitchLoop {
 public:
  // Fails where the log cannot be made.
  static Result<std::unique_ptr<SwitchLoop>> make(FootSwitchOptions options);
  ~SwitchLoop();
  SwitchLoop(const SwitchLoop&) = delete;
  SwitchLoop& operator=(const SwitchLoop&) = delete;

  // False where the memory never came.
  bool run();
  [[nodiscard]] const FootSwitchSummary& summary() const { return summary_; }

 private:
  explicit SwitchLoop(FootSwitchOptions options);
  bool wait_for_memory();
  void wait_until(Timestamp t);
  void listen(Timestamp now);
  void put_told();
  void release();
  void put(std::span<const SwitchChange> changes, Timestamp due);

  FootSwitchOptions options_;
  std::FILE* log_ = nullptr;
  std::unique_ptr<ControlFifo> control_;
  std::vector<SwitchChange> told_;  // by command, still to come; at_s counts from the start
  Timestamp started_;
  bool quit_ = false;
  SystemClock clock_;
  SegmentSeeker seeker_;
  FootSwitchSummary summary_;
};

}  // namespace cellmirror::sim
