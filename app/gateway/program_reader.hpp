// Reads and parses robot programs in a thread of its own: a long one takes a second, in which the owner of the cell has
// other things to do.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "app/gateway/program_files.hpp"

namespace cellmirror::app {

// Every function is called from one thread, the owner's.
class ProgramReader {
 public:
  struct Read {
    std::uint64_t id = 0;
    ProgramText text;
  };

  explicit ProgramReader(const KismetHome& home) : home_(home) {}
  // Waits for the file that is being read, about a second at most; those behind it are forgotten.
  ~ProgramReader() = default;
  ProgramReader(const ProgramReader&) = delete;
  ProgramReader& operator=(const ProgramReader&) = delete;

  // One after the other, in this order. The thread begins with the first.
  void read(std::uint64_t id, const program::Language& language, std::filesystem::path path);
  void forget(std::uint64_t id);  // unless it is being read, or has been
  // The next that has been read; none: not yet.
  [[nodiscard]] std::optional<Read> take();

 private:
  struct Order {
    std::uint64_t id = 0;
    const program::Language* language = nullptr;
    std::filesystem::path path;
  };
  void loop(const std::stop_token& stop);

  const KismetHome& home_;
  std::mutex mutex_;  // of the two below
  std::deque<Order> orders_;
  std::deque<Read> read_;
  std::condition_variable_any ordered_;
  std::jthread thread_;
};

}  // namespace cellmirror::app
