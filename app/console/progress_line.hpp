// A line on the terminal that is rewritten a few times a second; nothing where standard error is no terminal. One
// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

namespace cellmirror::app {

class ProgressLine {
 public:
  // "3 of 17 targets": `what` outlives the line.
  explicit ProgressLine(const char* what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // `now_at`: behind the numbers; may be empty.
  void update(std::uint64_t done, std::uint64_t total, std::string_view now_at = {});

 private:
  const char* what_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace cellmirror::app
