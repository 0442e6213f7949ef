// Formatted output to a stream. What cannot be written is told by ferror() in the end: fmt::print() would throw.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <utility>

namespace cellmirror::app {

template <class... Args>
void put(std::FILE* out, fmt::format_string<Args...> text, Args&&... args) {
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), text, std::forward<Args>(args)...);
  std::fwrite(line.data(), 1, line.size(), out);
}

}  // namespace cellmirror::app
