// The log of all SCRIPT commands: who sent what when, and what became of it. Kept over restarts.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/snapshot/command_record.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// One JSON object, without a line break (docs/messages.md). Texts are cut at kMostTextBytes.
[[nodiscard]] std::string command_line_of(const CommandRecord& record);

// JSON Lines in a file that only its owner can read (0600). A full file is renamed to FILE.1, that to FILE.2, and so
// on; the oldest is removed. Written by a thread of its own.
class CommandLog {
 public:
  static constexpr std::size_t kKept = 100;          // in the report; after a start those of the file
  static constexpr std::size_t kMostWaiting = 4096;  // to be written; more are dropped and counted
  static constexpr std::size_t kMostWaitingOfScripts =
      kMostWaiting / 2;  // of these, by SCRIPT files and robot programs
  static constexpr std::size_t kMostTextBytes = 8192;

  struct Options {
    std::filesystem::path file;  // its folder exists
    std::uint64_t most_bytes = std::uint64_t{4} << 20;
    int old_files = 4;
  };

  explicit CommandLog(Options options);
  // Writes what is left.
  ~CommandLog();
  CommandLog(const CommandLog&) = delete;
  CommandLog& operator=(const CommandLog&) = delete;

  // Waits for no file. Any thread.
  void add(CommandRecord record);
  [[nodiscard]] CommandLogReport report() const;
  // Of the commands since the start that are in the report, or were once. Any thread.
  [[nodiscard]] std::uint64_t count() const;

 private:
  void load_last();
  void loop();
  void write(const std::vector<CommandRecord>& records, std::uint64_t dropped);
  Result<void> append(const std::string& lines);
  Result<void> open();
  void rotate();
  void keep(std::string line);  // with the lock

  Options options_;
  Descriptor file_;          // the writer's
  std::uint64_t bytes_ = 0;  // in it

  mutable std::mutex mutex_;  // of what follows; held for moments only
  std::condition_variable came_;
  std::vector<CommandRecord> waiting_;
  bool ending_ = false;
  std::deque<std::string> last_;
  std::uint64_t count_ = 0;
  std::uint64_t written_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t dropped_noted_ = 0;  // in the file
  std::string problem_;

  std::thread thread_;
};

}  // namespace cellmirror::app
