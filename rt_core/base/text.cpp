#include "rt_core/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace cellmirror {

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Levenshtein distance without regard to case, two neighbours in the wrong order being one edit. Row by row. Lengths
// are bounded by the caller.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [&](std::size_t i, std::size_t j) { return lower(a[i - 1]) == lower(b[j - 1]); };
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  std::vector<std::size_t> above = row;
  std::vector<std::size_t> two_above = row;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same(i, j) ? 0U : 1U)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), lower);
  return out;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<long long> parse_integer(std::string_view text) {
  int base = 10;
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
    base = 16;
    if (text.starts_with('-')) return std::nullopt;
  }
  if (text.empty() || text.starts_with('+')) return std::nullopt;
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string> nearest(std::string_view wrong, std::span<const std::string> candidates, std::size_t most) {
  constexpr std::size_t kLongest = 200;  // keeps the work bounded for hostile names
  if (wrong.size() > kLongest) return {};
  const std::size_t far = std::max<std::size_t>(2, wrong.size() / 3);
  // Of a short word half must be right, since two letters make any name out of one; unless it is how the name begins.
  const std::size_t far_of_any = std::min(wrong.size() / 2, far);
  constexpr std::size_t kBeginning = 3;
  const auto begins = [&](const std::string& candidate) {
    return wrong.size() >= kBeginning && candidate.size() > wrong.size() &&
           equal_ignoring_case(std::string_view(candidate).substr(0, wrong.size()), wrong);
  };
  std::vector<std::pair<std::size_t, const std::string*>> near;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest || candidate.size() > wrong.size() + far || wrong.size() > candidate.size() + far)
      continue;
    const std::size_t distance = edit_distance(wrong, candidate);
    if (distance <= (begins(candidate) ? far : far_of_any)) near.emplace_back(distance, &candidate);
  }
  // The pointers go into one array, so they keep the candidates' order among equal distances.
  std::sort(near.begin(), near.end());
  std::vector<std::string> out;
  for (std::size_t i = 0; i < near.size() && i < most; ++i) out.push_back(*near[i].second);
  return out;
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string> candidates) {
  const std::vector<std::string> names = nearest(wrong, candidates);
  if (names.empty()) return {};
  std::string out = "did you mean " + names[0];
  for (std::size_t i = 1; i < names.size(); ++i) out += (i + 1 == names.size() ? " or " : ", ") + names[i];
  return out + "?";
}

std::string printable(std::string_view bytes, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i == most) return out + fmt::format("... ({} bytes)", bytes.size());
    const auto byte = static_cast<unsigned char>(bytes[i]);
    out += byte < 0x20 || byte >= 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, bytes[i]);
  }
  return out;
}

}  // namespace cellmirror
