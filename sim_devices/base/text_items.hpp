// Pieces of the simulators' small languages: blank-separated words, times with their unit, key=value.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace cellmirror::sim {

// "2s", "250ms"; seconds, 0 to 1e6. None for a number without its unit.
[[nodiscard]] std::optional<double> parse_duration(std::string_view text);

// At most `most` pieces, trimmed; the rest stays together in the last one. Empty pieces are kept.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char at, std::size_t most);

// Words between blanks, tabs, line ends and colons, which replace blanks in a shell; at most `most`, the rest is
// dropped.
[[nodiscard]] std::vector<std::string_view> words(std::string_view text, std::size_t most);

struct KeyValue {
  std::string_view key;
  std::string_view value;
};
// "key=value"; none where there is no '='.
[[nodiscard]] std::optional<KeyValue> parse_key_value(std::string_view word);

}  // namespace cellmirror::sim
