// Reads the gateway's answers and keeps count of them. What is in the memory is anybody's: checked and bounded here.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/ports/haptic_device.hpp"
#include "sim_devices/haptic/summary.hpp"

namespace cellmirror::sim {

class ForceReader {
 public:
  explicit ForceReader(HapticSummary& summary) : summary_(summary) {}

  // True where a new answer was read. `written`: when each sample was written; times of answers count from there.
  bool read(std::span<const std::byte> memory, Timestamp now, const WriteTimes& written);
  // The memory is another one now.
  void restart() { started_ = false; }

  // Sequence of the newest sample that was answered.
  [[nodiscard]] std::uint64_t answered() const { return last_answers_; }
  // The last answer, without values that are no numbers; zero force where the gateway has been silent for long.
  [[nodiscard]] const HapticOutput& output() const { return output_; }

 private:
  void count(const HapticOutput& output, Timestamp now, const WriteTimes& written);

  HapticSummary& summary_;
  HapticOutput output_;
  Timestamp last_news_;
  std::uint64_t last_answers_ = 0;
  bool started_ = false;
  bool silent_ = true;
};

}  // namespace cellmirror::sim
