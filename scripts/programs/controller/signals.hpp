// Inputs and outputs of the robots, and the semaphores of the cell. One thread: the owner of the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// Of one robot. All are off (0) in the beginning; numbers from 1 to kMostPorts.
struct SignalBoard {
  std::vector<bool> digital_inputs = std::vector<bool>(kMostPorts + 1);
  std::vector<bool> digital_outputs = std::vector<bool>(kMostPorts + 1);
  std::vector<double> analogue_inputs = std::vector<double>(kMostPorts + 1);
  std::vector<double> analogue_outputs = std::vector<double>(kMostPorts + 1);
  Timestamp changed;  // the newest instant at which any of them was set
};

// Counting semaphores, known by name to all programs.
class Semaphores {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::uint32_t kMostCount = 1'000'000;

  // Makes it where it is not known; an initial count that differs from the first one is refused.
  Result<void> declare(std::string_view name, std::uint32_t initial);
  // One that was never declared begins with 0.
  [[nodiscard]] bool try_acquire(std::string_view name);
  [[nodiscard]] bool available(std::string_view name) const;  // to the next program
  // Refused: beyond kMostCount, or kMost.
  Result<void> release(std::string_view name, Timestamp when);
  // When it was released last; never: not yet.
  [[nodiscard]] Timestamp released(std::string_view name) const;
  // `who` ("B owner was stopped") had acquired it and would have released it; deadlock reports show that until another
  // program releases it, make_up(), or it is reset.
  void keep(std::string_view name, std::string who);
  void make_up(std::string_view name);
  [[nodiscard]] std::vector<std::string> kept_by(std::string_view name) const;
  // As it was declared; 0 where it was not. Unknown ones are passed over.
  void reset(std::string_view name);
  void forget(std::string_view name);
  // As counts are now.
  [[nodiscard]] std::map<std::string, std::uint32_t> counts() const;

 private:
  struct Semaphore {
    std::uint32_t count = 0;
    std::uint32_t initial = 0;
    bool declared = false;
    Timestamp released;
    std::vector<std::string> kept_by;  // the oldest first, each once
  };
  Result<Semaphore*> open(std::string_view name);

  std::map<std::string, Semaphore, std::less<>> semaphores_;
};

}  // namespace cellmirror::program
