// Text of bounded length without heap, trivially copyable, for records that cross threads and processes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace cellmirror {

template <std::size_t N>
struct FixedText {
  std::array<char, N + 1> bytes{};  // NUL-terminated

  constexpr FixedText() = default;
  // Longer text is cut at N bytes.
  constexpr FixedText(std::string_view text) { assign(text); }  // NOLINT: a text is a text

  constexpr void assign(std::string_view text) {
    const std::size_t n = std::min(text.size(), N);
    bytes.fill('\0');
    std::copy_n(text.data(), n, bytes.data());
  }
  [[nodiscard]] constexpr std::string_view view() const {
    return {bytes.data(), static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), '\0') - bytes.begin())};
  }
  friend constexpr bool operator==(const FixedText& a, std::string_view b) { return a.view() == b; }
};

}  // namespace cellmirror
