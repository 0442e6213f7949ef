// Formatted output to a stream. A failure to write shows in ferror() at the end; fmt::print() would throw.
#pragma once

#include <fmt/core.h>

#include <cstdio>

namespace cellmirror::app {

// put() with its arguments bundled. The formatting itself stays out of the header: it takes seconds to compile.
void put_bundled(std::FILE* out, fmt::string_view text, fmt::format_args args);

template <class... Args>
void put(std::FILE* out, fmt::format_string<Args...> text, Args&&... args) {
  put_bundled(out, text, fmt::make_format_args(args...));
}

}  // namespace cellmirror::app
