// Inputs and outputs of the robots, and the semaphores of the cell. One thread: the owner of the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// Of one robot. All are off (0) in the beginning; numbers from 1 to kMostPorts.
struct SignalBoard {
  std::vector<bool> digital_inputs = std::vector<bool>(kMostPorts + 1);
  std::vector<bool> digital_outputs = std::vector<bool>(kMostPorts + 1);
  std::vector<double> analogue_inputs = std::vector<double>(kMostPorts + 1);
  std::vector<double> analogue_outputs = std::vector<double>(kMostPorts + 1);
};

// Counting semaphores, known by name to all programs. Who waits first is served first.
class Semaphores {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::uint32_t kMostCount = 1'000'000;

  // Makes it where it is not known; an initial count that differs from the first one is refused.
  Result<void> declare(std::string_view name, std::uint32_t initial);
  // One that was never declared begins with 0.
  [[nodiscard]] bool try_acquire(std::string_view name);
  Result<void> release(std::string_view name);  // refused: beyond kMostCount
  [[nodiscard]] const std::map<std::string, std::uint32_t, std::less<>>& counts() const { return counts_; }

 private:
  std::map<std::string, std::uint32_t, std::less<>> counts_;
  std::map<std::string, std::uint32_t, std::less<>> initial_;
};

}  // namespace cellmirror::program
