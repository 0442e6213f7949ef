#include "rt_core/base/base64.hpp"

#include <algorithm>
#include <array>

namespace cellmirror {

namespace {

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  for (auto& value : values) value = -1;
  for (std::size_t i = 0; i < kLetters.size(); ++i)
    values[static_cast<unsigned char>(kLetters[i])] = static_cast<std::int8_t>(i);
  return values;
}
constexpr std::array<std::int8_t, 256> kValues = make_values();

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < n ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kLetters[word >> (18U - 6U * k) & 63U] : '=';
  }
  return out;
}

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  const std::size_t letters = text.size() - padding;
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < letters; ++i) {
    const std::int8_t value = kValues[static_cast<unsigned char>(text[i])];
    if (value < 0) return std::nullopt;
    word = word << 6U | static_cast<std::uint8_t>(value);
    if (i % 4 == 1) out.push_back(static_cast<std::uint8_t>(word >> 4U));
    if (i % 4 == 2) out.push_back(static_cast<std::uint8_t>(word >> 2U));
    if (i % 4 == 3) out.push_back(static_cast<std::uint8_t>(word));
  }
  // What is beyond the last byte is zero (RFC 4648, 3.5).
  const std::uint32_t rest = padding == 2 ? word & 15U : padding == 1 ? word & 3U : 0U;
  if (rest != 0) return std::nullopt;
  return out;
}

}  // namespace cellmirror
