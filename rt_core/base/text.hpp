// Small helpers for text that people write and read.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cellmirror {

// ASCII only: SCRIPT keywords are matched without regard to case.
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);
[[nodiscard]] std::string lower_case(std::string_view text);
[[nodiscard]] std::string_view trimmed(std::string_view text);

// Decimal or exponent form, whole text; none where anything is left over, and for inf and nan. "1.", ".5" and a leading
// "+" are accepted.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
// Decimal, or hexadecimal with 0x; whole text.
[[nodiscard]] std::optional<long long> parse_integer(std::string_view text);

// Up to `most` of the candidates, nearest to `wrong` by edit distance first; only such that a person may have meant.
[[nodiscard]] std::vector<std::string> nearest(std::string_view wrong, std::span<const std::string> candidates,
                                               std::size_t most = 3);
// "did you mean A, B or C?", or empty where nothing is near.
[[nodiscard]] std::string did_you_mean(std::string_view wrong, std::span<const std::string> candidates);

// Printable form of bytes from outside, for messages and logs: control and non-ASCII bytes as \xNN, cut at `most`.
[[nodiscard]] std::string printable(std::string_view bytes, std::size_t most = 80);

}  // namespace cellmirror
