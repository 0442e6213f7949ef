// A line on the terminal that is written anew a few times a second; nothing where standard error is no terminal. One
// thread.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "app/subcommands/put.hpp"

namespace cellmirror::app {

class ProgressLine {
 public:
  // "3 of 17 targets": `what` outlives the line.
  explicit ProgressLine(const char* what) : what_(what), shown_(isatty(STDERR_FILENO) == 1) {}
  ~ProgressLine() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // `now_at`: behind the numbers; may be empty.
  void tell(std::uint64_t done, std::uint64_t total, std::string_view now_at = {}) {
    constexpr std::chrono::milliseconds kEvery{250};
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < kEvery) return;
    last_ = now;
    drawn_ = true;
    put(stderr, "\r\x1b[K{} of {} {}{}{}", done, total, what_, now_at.empty() ? "" : ": ", now_at);
  }

 private:
  const char* what_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace cellmirror::app
