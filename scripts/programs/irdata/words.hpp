// Fixed words of the dialect, found without regard to case.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace cellmirror::program::irdata {

// Letters, digits and underscores: what names and words are made of.
[[nodiscard]] constexpr bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }
[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
[[nodiscard]] constexpr bool is_name_part(char c) { return is_letter(c) || is_digit(c); }

class WordTable {
 public:
  static constexpr std::size_t kNone = 0xFFFF;

  // `words`: upper case, each once, at most 200, not empty; they must outlive the table.
  explicit WordTable(std::span<const std::string_view> words);
  // Index in the list; kNone where it is not among them. Allocates nothing.
  [[nodiscard]] std::size_t find(std::string_view word) const;

 private:
  static constexpr std::size_t kSlots = 1024;
  std::span<const std::string_view> words_;
  std::array<std::uint8_t, kSlots> slots_{};  // index + 1; 0: free
};

}  // namespace cellmirror::program::irdata
