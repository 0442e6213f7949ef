// A record of every period as CSV: the loop hands rows over, a thread writes them.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rt_core/base/result.hpp"
#include "sim_devices/haptic/axes.hpp"

namespace cellmirror::sim {

struct HapticLogRow {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, when the sample was written (a watcher: when the row was read)
  std::uint64_t sequence = 0;
  std::int64_t sample_time_ns = 0;  // as the sample says
  std::uint32_t writer = 0;         // process id, as the sample says
  Coordinates axes{};               // as written, m or rad
  Coordinates efforts{};            // as felt, N or Nm
  std::uint64_t force_sequence = 0;
  std::int64_t force_time_ns = 0;
  std::uint64_t answers = 0;
  std::uint32_t phase = 0;
  std::uint32_t fault = 0;  // the gateway's HapticFault
  double force_n = 0;
  double torque_nm = 0;
  std::uint32_t struck = 0;  // bit a fault of ours that is in force, in their order
};

class HapticLog {
 public:
  // Fails where the file cannot be made.
  static Result<std::unique_ptr<HapticLog>> make(const std::string& path, const AxisLayout& layout);
  ~HapticLog();  // writes what is left
  HapticLog(const HapticLog&) = delete;
  HapticLog& operator=(const HapticLog&) = delete;

  void add(const HapticLogRow& row);
  // Returns when everything so far is in the file.
  void flush();

 private:
  HapticLog(std::FILE* file, std::size_t axes) : file_(file), axes_(axes) {}
  void work();
  void write(const std::vector<HapticLogRow>& rows);

  std::FILE* file_;
  std::size_t axes_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable written_;
  std::vector<HapticLogRow> rows_;
  bool busy_ = false;
  bool hurry_ = false;
  bool end_ = false;
  std::thread thread_;
};

// The largest of all that an answer pushes with, N: force at the handle and at the tip.
[[nodiscard]] double force_size(const HapticOutput& output);
// Likewise Nm: torque at the handle and the gripper, and the joints' torques (N of a sliding one).
[[nodiscard]] double torque_size(const HapticOutput& output);

}  // namespace cellmirror::sim
