#include "drivers/can/channel/candump_line.hpp"

#include <fmt/format.h>

#include <optional>

namespace cellmirror::can {
namespace {

constexpr std::uint32_t kErrorFlag = 0x2000'0000;  // CAN_ERR_FLAG of linux/can.h
constexpr std::size_t kMaxInterfaceName = 15;      // IFNAMSIZ - 1
constexpr std::size_t kMaxSecondsDigits = 10;

std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  return {};
}

// Splits off what stands before the first blank.
std::string_view next_word(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  std::size_t end = text.find_first_of(" \t");
  if (end == std::string_view::npos) end = text.size();
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

std::optional<std::int64_t> parse_stamp(std::string_view word) {
  if (word.size() < 5 || word.front() != '(' || word.back() != ')') return {};
  word = word.substr(1, word.size() - 2);
  const std::size_t dot = word.find('.');
  if (dot == std::string_view::npos || dot == 0 || dot > kMaxSecondsDigits) return {};
  const std::string_view fraction = word.substr(dot + 1);
  if (fraction.empty() || fraction.size() > 9) return {};
  std::int64_t ns = 0;
  for (const char c : word.substr(0, dot)) {
    if (c < '0' || c > '9') return {};
    ns = ns * 10 + (c - '0');
  }
  for (std::size_t i = 0; i < 9; ++i) {
    const char c = i < fraction.size() ? fraction[i] : '0';
    if (c < '0' || c > '9') return {};
    // Ten digits of seconds do not all fit into 64 bits of nanoseconds.
    if (ns > 900'000'000'000'000'000) return {};
    ns = ns * 10 + (c - '0');
  }
  return ns;
}

std::string_view parse_id(std::string_view text, CanFrame& frame) {
  if (text.size() != 3 && text.size() != 8) return "the identifier has neither 3 nor 8 digits";
  std::uint32_t id = 0;
  for (const char c : text) {
    const auto digit = hex_digit(c);
    if (!digit) return "the identifier is not hexadecimal";
    id = id << 4 | *digit;
  }
  frame.extended = text.size() == 8;
  if (frame.extended && (id & kErrorFlag) != 0) {
    frame.error = true;
    frame.extended = false;
    id &= ~kErrorFlag;
  }
  frame.id = id;
  if (id >= (frame.extended || frame.error ? 0x2000'0000U : 0x800U)) return "the identifier is too large";
  return {};
}

std::string_view parse_remote(std::string_view text, CanFrame& frame) {
  frame.remote = true;
  if (frame.error) return "an error frame cannot be a remote frame";
  if (text.empty()) return {};
  if (text.size() > 1 || text[0] < '0' || text[0] > '8') return "the length of a remote frame is one digit from 0 to 8";
  frame.length = static_cast<std::uint8_t>(text[0] - '0');
  return {};
}

std::string_view parse_data(std::string_view text, CanFrame& frame) {
  const std::size_t most = frame.fd ? kCanMaxData : 8;
  std::size_t count = 0;
  while (!text.empty()) {
    if (text.front() == '.') {
      text.remove_prefix(1);
      continue;
    }
    // "_9" to "_F": the raw DLC of a classic frame of 8 bytes.
    if (text.front() == '_' && !frame.fd && count == 8 && text.size() == 2) {
      const auto dlc = hex_digit(text[1]);
      if (!dlc || *dlc < 9) return "the raw DLC is not one of 9 to F";
      break;
    }
    if (text.size() < 2) return "an odd number of digits of data";
    const auto high = hex_digit(text[0]);
    const auto low = hex_digit(text[1]);
    if (!high || !low) return "the data are not hexadecimal";
    if (count == most) return "too many bytes of data";
    frame.data[count++] = static_cast<std::uint8_t>(*high << 4 | *low);
    text.remove_prefix(2);
  }
  frame.length = static_cast<std::uint8_t>(count);
  return {};
}

std::string_view parse_frame(std::string_view text, CanFrame& frame) {
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos) return "no # between identifier and data";
  if (const auto reason = parse_id(text.substr(0, hash), frame); !reason.empty()) return reason;
  text.remove_prefix(hash + 1);
  if (text.starts_with('#')) {
    if (text.size() < 2 || frame.error) return "no flags behind ##";
    const auto flags = hex_digit(text[1]);
    if (!flags) return "the flags behind ## are not hexadecimal";
    frame.fd = true;
    frame.bit_rate_switch = (*flags & 1U) != 0;
    frame.error_state_indicator = (*flags & 2U) != 0;
    return parse_data(text.substr(2), frame);
  }
  if (text.starts_with('R') || text.starts_with('r')) return parse_remote(text.substr(1), frame);
  return parse_data(text, frame);
}

}  // namespace

std::expected<CandumpLine, std::string_view> parse_candump_line(std::string_view line) {
  if (line.size() > kCandumpLineCapacity) return std::unexpected("the line is too long");
  if (line.ends_with('\r')) line.remove_suffix(1);
  CandumpLine result;
  const auto stamp = parse_stamp(next_word(line));
  if (!stamp) return std::unexpected("no time stamp as (1436509052.249713)");
  result.time_ns = *stamp;
  result.interface = next_word(line);
  if (result.interface.empty() || result.interface.size() > kMaxInterfaceName) {
    return std::unexpected("no name of an interface");
  }
  const std::string_view reason = parse_frame(next_word(line), result.frame);
  if (!reason.empty()) return std::unexpected(reason);
  const std::string_view direction = next_word(line);
  if (!direction.empty() && direction != "R" && direction != "T") return std::unexpected("text behind the frame");
  if (!next_word(line).empty()) return std::unexpected("text behind the frame");
  return result;
}

std::string format_candump_line(std::int64_t time_ns, std::string_view interface, const CanFrame& frame) {
  std::string text;
  text += fmt::format("({:010}.{:06}) {} ", time_ns / 1'000'000'000, time_ns % 1'000'000'000 / 1000, interface);
  if (frame.error) {
    text += fmt::format("{:08X}#", frame.id | kErrorFlag);
  } else if (frame.extended) {
    text += fmt::format("{:08X}#", frame.id);
  } else {
    text += fmt::format("{:03X}#", frame.id);
  }
  if (frame.remote) {
    text += 'R';
    if (frame.length > 0) text += fmt::format("{}", frame.length);
    return text;
  }
  if (frame.fd) {
    const unsigned flags = (frame.bit_rate_switch ? 1U : 0U) | (frame.error_state_indicator ? 2U : 0U);
    text += fmt::format("#{:X}", flags);
  }
  for (const std::uint8_t b : frame.payload()) text += fmt::format("{:02X}", b);
  return text;
}

}  // namespace cellmirror::can
