// Options and progress line of the subcommands that read a recording.
#pragma once

#include <cstdint>
#include <optional>

#include "app/console/progress_line.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/record/record_stream.hpp"

namespace cellmirror::app {

inline void add_decompressed_limit(cli::Command& command, std::optional<double>& gb) {
  command
      .option("--decompressed-limit", gb,
              "limit of the decompressed chunks in GB; default: 1.1, or 200 times the size of the file if that is more")
      .between(0.001, 1e6);
}

[[nodiscard]] inline mcap::Limits limits_of(const std::optional<double>& decompressed_gb) {
  mcap::Limits out;
  if (decompressed_gb) out.decompressed_bytes = static_cast<std::uint64_t>(1e9 * *decompressed_gb);
  if (decompressed_gb) out.decompressed_ratio = 0;
  return out;
}

// Outlives the reader. `shown` is false where the progress line would mix with output on the same terminal.
class ReadingWatch {
 public:
  explicit ReadingWatch(bool shown = true)
      : progress_([this](std::uint64_t done, std::uint64_t total) {
          constexpr std::uint64_t kKilo = 1000;
          if (line_) line_->update(done / kKilo, total / kKilo);
        }) {
    if (shown) line_.emplace("kB of the recording");
  }
  ReadingWatch(const ReadingWatch&) = delete;
  ReadingWatch& operator=(const ReadingWatch&) = delete;

  [[nodiscard]] mcap::Limits watched(mcap::Limits limits) const {
    limits.progress = &progress_;
    return limits;
  }
  // Removes the progress line; call it before other output on the terminal.
  void end() { line_.reset(); }

 private:
  std::optional<ProgressLine> line_;
  mcap::ReadProgress progress_;
};

}  // namespace cellmirror::app
