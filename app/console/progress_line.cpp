#include "app/console/progress_line.hpp"

#include <unistd.h>

#include <cstdio>

#include "app/console/put.hpp"

namespace cellmirror::app {

ProgressLine::ProgressLine(const char* what) : what_(what), shown_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressLine::update(std::uint64_t done, std::uint64_t total, std::string_view now_at) {
  constexpr std::chrono::milliseconds kEvery{250};
  const auto now = std::chrono::steady_clock::now();
  if (!shown_ || now - last_ < kEvery) return;
  last_ = now;
  drawn_ = true;
  put(stderr, "\r\x1b[K{} of {} {}{}{}", done, total, what_, now_at.empty() ? "" : ": ", now_at);
}

}  // namespace cellmirror::app
