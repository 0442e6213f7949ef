#include "rt_core/base/shell_word.hpp"

#include <algorithm>

namespace cellmirror {

std::string shell_word(std::string_view text) {
  constexpr std::string_view kHarmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.,:=/@+";
  const auto harmless = [&](char c) { return kHarmless.find(c) != std::string_view::npos; };
  if (!text.empty() && std::ranges::all_of(text, harmless)) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace cellmirror
