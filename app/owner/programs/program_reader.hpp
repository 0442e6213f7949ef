// Reads and parses robot programs in a thread of its own: a long one takes a second, in which the owner of the cell has
// other things to do.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "app/owner/programs/program_files.hpp"

namespace cellmirror::app {

// Every function is called from one thread, the owner's.
class ProgramReader {
 public:
  struct Read {
    std::uint64_t id = 0;
    ProgramText text;
  };

  // Called in the thread; what it throws refuses the program.
  using Reading = std::function<ProgramText(const program::Language& language, const std::filesystem::path& path)>;

  explicit ProgramReader(Reading reading) : reading_(std::move(reading)) {}
  // Waits for the file that is being read: about a second, some seconds for 64 MiB of faults. Those behind it are
  // forgotten.
  ~ProgramReader() = default;
  ProgramReader(const ProgramReader&) = delete;
  ProgramReader& operator=(const ProgramReader&) = delete;

  // One after the other, in this order. The thread begins with the first. Refused: the system gives no thread.
  Result<void> read(std::uint64_t id, const program::Language& language, std::filesystem::path path);
  void forget(std::uint64_t id);  // unless it is being read, or has been
  // The next that has been read; none: not yet.
  [[nodiscard]] std::optional<Read> take();

 private:
  struct Order {
    std::uint64_t id = 0;
    const program::Language* language = nullptr;
    std::filesystem::path path;
  };
  Result<void> start_thread();
  void loop(const std::stop_token& stop);
  [[nodiscard]] ProgramText text_of(const Order& order) const;

  const Reading reading_;
  std::mutex mutex_;  // of the two below
  std::deque<Order> orders_;
  std::deque<Read> read_;
  std::condition_variable_any ordered_;
  std::jthread thread_;
};

}  // namespace cellmirror::app
