#include "sim_devices/base/text_items.hpp"

#include "rt_core/base/text.hpp"

namespace cellmirror::sim {
namespace {

constexpr double kLongest = 1e6;
constexpr std::string_view kBlanks = " \t\r\n:";

}  // namespace

std::optional<double> parse_duration(std::string_view text) {
  text = trimmed(text);
  if (!text.ends_with('s')) return std::nullopt;
  text.remove_suffix(1);
  double scale = 1;
  if (text.ends_with('m')) {
    text.remove_suffix(1);
    scale = 1e-3;
  }
  if (text.empty() || trimmed(text).size() != text.size()) return std::nullopt;
  const auto number = parse_number(text);
  if (!number || *number < 0 || *number * scale > kLongest) return std::nullopt;
  return *number * scale;
}

std::vector<std::string_view> split(std::string_view text, char at, std::size_t most) {
  std::vector<std::string_view> pieces;
  while (pieces.size() + 1 < most) {
    const std::size_t end = text.find(at);
    if (end == std::string_view::npos) break;
    pieces.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end + 1);
  }
  pieces.push_back(trimmed(text));
  return pieces;
}

std::vector<std::string_view> words(std::string_view text, std::size_t most) {
  std::vector<std::string_view> found;
  while (found.size() < most) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) break;
    const std::size_t end = text.find_first_of(kBlanks, begin);
    found.push_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end);
  }
  return found;
}

std::optional<KeyValue> parse_key_value(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  return KeyValue{trimmed(word.substr(0, equals)), trimmed(word.substr(equals + 1))};
}

}  // namespace cellmirror::sim
