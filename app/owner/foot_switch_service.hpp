// Foot switches: their memory, the thread that watches it, and the SCRIPT files that run (bin_ela_shm, BIN_ELA, manual
// 1.2.6). Belongs to the thread that owns the cell.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/snapshot/foot_switch_snapshot.hpp"
#include "config/foot_switches.hpp"
#include "drivers/footswitch/switch_reader.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "scripts/runner/input_scripts.hpp"

namespace cellmirror::app {

class FootSwitchService {
 public:
  struct Options {
    FootSwitchSettings settings;
    std::string instance;
    int priority = 0;                                                  // SCHED_FIFO of the watching thread; 0: none
    std::function<void()> wake;                                        // wakes the owner's thread
    std::function<void(const FootSwitchChange& change)> changed = {};  // with each change that is taken
  };

  // Runner, home and clock outlive the service.
  FootSwitchService(Options options, script::ScriptRunner& runner, const KismetHome& home, const Clock& clock);
  FootSwitchService(const FootSwitchService&) = delete;
  FootSwitchService& operator=(const FootSwitchService&) = delete;

  // What the cell file says: the memory is made, and processing begins where it says so.
  Result<void> prepare();
  // bin_ela_shm. Refused: the memory cannot be had. Where inputs are processed they are processed from now on there.
  Result<void> set_memory(std::int32_t key, std::size_t bytes);
  // BIN_ELA. Refused: online without a memory. What waits is forgotten with offline.
  Result<void> set_online(bool online);

  // STOP_ALL: scripts of changes that were found already are not started. Those of later changes are.
  void forget_waiting();

  // Takes what the thread has found and starts the next script. True where one was started, which then has the next
  // turn. Before and after each step of the runner.
  bool follow();
  // True while scripts run or wait.
  [[nodiscard]] bool busy() const { return !scripts_.idle(); }

  [[nodiscard]] FootSwitchSnapshot snapshot() const;

 private:
  void take_edges();
  void take(const footswitch::SwitchEdge& edge);
  void start_watching();
  void stop_watching();
  void check_memory();

  Options options_;
  const Clock& clock_;
  script::InputScripts scripts_;
  std::unique_ptr<SharedSegment> memory_;
  std::unique_ptr<footswitch::SwitchReader> reader_;  // after the memory that it looks at
  footswitch::SwitchReader::Counters earlier_;        // of readers that have ended
  Timestamp last_check_;
  SegmentUsers users_;
  std::string trouble_;
  LatencyHistogram first_command_;
};

}  // namespace cellmirror::app
