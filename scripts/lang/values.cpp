#include "scripts/lang/values.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstddef>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/lang/command_table.hpp"

namespace cellmirror::script {

namespace {

constexpr long long kLargestExactInteger = 1LL << 53;  // every whole number up to it is a double

// A number with its typographic dashes made plain; longer words are no numbers.
class PlainNumber {
 public:
  explicit PlainNumber(const Token& token) {
    if (token.plain) {
      text_ = token.text;
      return;
    }
    // Figure dash, en dash, em dash, minus sign in UTF-8; en dash and em dash in CP1252.
    constexpr std::array<std::string_view, 6> kDashes = {"\xe2\x80\x92", "\xe2\x80\x93", "\xe2\x80\x94",
                                                         "\xe2\x88\x92", "\x96",         "\x97"};
    std::string_view rest = token.text;
    std::size_t n = 0;
    while (!rest.empty()) {
      if (n == buffer_.size()) return;
      char c = rest.front();
      std::size_t taken = 1;
      for (const std::string_view dash : kDashes) {
        if (!rest.starts_with(dash)) continue;
        c = '-';
        taken = dash.size();
      }
      buffer_[n++] = c;
      rest.remove_prefix(taken);
    }
    text_ = {buffer_.data(), n};
  }
  PlainNumber(const PlainNumber&) = delete;
  PlainNumber& operator=(const PlainNumber&) = delete;

  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  std::array<char, 64> buffer_;  // of words that are not plain
  std::string_view text_;
};

bool has_two_signs(std::string_view text) { return text.starts_with("+-"); }

}  // namespace

std::optional<double> number_of(const Token& token) {
  const PlainNumber plain(token);
  if (has_two_signs(plain.text())) return std::nullopt;
  return parse_number(plain.text());
}

std::optional<double> integer_of(const Token& token) {
  const PlainNumber plain(token);
  if (has_two_signs(plain.text())) return std::nullopt;
  const std::optional<long long> value = parse_integer(plain.text());
  if (!value || *value > kLargestExactInteger || *value < -kLargestExactInteger) return std::nullopt;
  return static_cast<double>(*value);
}

std::string_view why_no_number(const Token& token, bool integer) {
  const PlainNumber plain(token);
  double value = 0;
  const std::string_view text = plain.text();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = end == text.data() + text.size() && !text.empty();
  if (whole && error == std::errc::result_out_of_range) return "is beyond the range of numbers";
  if (whole && error == std::errc{} && !parse_number(text)) return "is not a finite number";
  if (integer && whole && error == std::errc{}) return "is not a whole number within range";
  return integer ? "is not a whole number" : "is not a number";
}

std::optional<std::size_t> choice_of(std::string_view word, std::span<const Choice> choices) {
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (equal_ignoring_case(word, choices[i].word)) return i;
  }
  return std::nullopt;
}

double to_si(double value, Unit unit, JointKind kind) {
  switch (unit) {
    case Unit::none:
    case Unit::metre:
    case Unit::second:
    case Unit::newton:
    case Unit::newton_metre:
    case Unit::byte:
    case Unit::by_fly_type:
    case Unit::by_plausibility:
      return value;
    case Unit::mm:
    case Unit::mm_per_s:
    case Unit::mm_per_s2:
      return m_from_mm(value);
    case Unit::degree:
    case Unit::degree_per_s:
    case Unit::degree_per_s2:
      return rad_from_deg(value);
    case Unit::joint_position:
    case Unit::by_effector_joint:
      return kind == JointKind::prismatic ? m_from_mm(value) : rad_from_deg(value);
    case Unit::joint_velocity:
    case Unit::joint_acceleration:
      return kind == JointKind::prismatic ? m_from_mm(value) : value;
  }
  return value;
}

std::string range_text(const Range& range, Unit unit) {
  const std::string_view name = unit_text(unit);
  const std::string shown = name.empty() ? "" : " " + std::string(name);
  const bool has_low = range.low > -std::numeric_limits<double>::max();
  const bool has_high = range.high < std::numeric_limits<double>::max();
  if (has_low && has_high && !range.low_excluded && !range.high_excluded)
    return fmt::format("{}..{}{}", range.low, range.high, shown);
  const std::string low = fmt::format("{} {}", range.low_excluded ? "more than" : "at least", range.low);
  const std::string high = fmt::format("{} {}", range.high_excluded ? "less than" : "at most", range.high);
  if (has_low && has_high) return low + " and " + high + shown;
  if (has_low) return low + shown;
  if (has_high) return high + shown;
  return "any number" + shown;
}

}  // namespace cellmirror::script
