#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/dbc/dbc.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr int kMaxMultiplexerDepth = 8;

// The bit below `bit` in a big-endian signal: down within the byte, then to the top of the next byte (saw-tooth).
constexpr std::size_t next_lower(std::size_t bit) { return bit % 8 == 0 ? bit + 15 : bit - 1; }

std::size_t last_bit(const DbcSignal& signal) {
  if (signal.order == ByteOrder::little_endian) return std::size_t{signal.start} + signal.length - 1;
  // Position from the top of byte 0, in the order in which the bits are sent.
  const std::size_t first = std::size_t{signal.start} / 8 * 8 + (7 - signal.start % 8);
  return first + signal.length - 1;
}

std::uint64_t big_endian_bits(const DbcSignal& signal, std::span<const std::uint8_t> data) {
  std::uint64_t value = 0;
  std::size_t bit = signal.start;
  for (std::size_t i = 0; i < signal.length; ++i) {
    value = value << 1 | (data[bit / 8] >> (bit % 8) & 1U);
    bit = next_lower(bit);
  }
  return value;
}

}  // namespace

bool is_present(const DbcMessage& message, const DbcSignal& signal, std::span<const std::uint8_t> data) {
  // Nested multiplexers: each level up has to be there too. Bounded: a file may name a circle.
  const DbcSignal* level = &signal;
  for (int depth = 0; depth < kMaxMultiplexerDepth; ++depth) {
    if (!level->is_multiplexed) return true;
    const DbcSignal* multiplexer =
        level->multiplexer.empty() ? message.multiplexer() : message.find(level->multiplexer);
    if (multiplexer == nullptr || multiplexer == level) return false;
    const std::uint64_t value = raw_value(*multiplexer, data);
    const auto& ranges = level->multiplexer_values;
    const bool hit = std::any_of(ranges.begin(), ranges.end(),
                                 [value](const auto& range) { return value >= range.first && value <= range.second; });
    if (!hit) return false;
    level = multiplexer;
  }
  return false;
}

std::size_t bytes_needed(const DbcSignal& signal) { return last_bit(signal) / 8 + 1; }

std::uint64_t raw_value(const DbcSignal& signal, std::span<const std::uint8_t> data) {
  CELLMIRROR_EXPECTS(data.size() >= bytes_needed(signal));
  if (signal.order == ByteOrder::little_endian) return get_bits(data, signal.start, signal.length);
  return big_endian_bits(signal, data);
}

double physical_value(const DbcSignal& signal, std::span<const std::uint8_t> data) {
  const std::uint64_t raw = raw_value(signal, data);
  double value = 0;
  if (signal.type == DbcValueType::float32) {
    value = std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  } else if (signal.type == DbcValueType::float64) {
    value = std::bit_cast<double>(raw);
  } else if (signal.is_signed) {
    value = static_cast<double>(sign_extended(raw, signal.length));
  } else {
    value = static_cast<double>(raw);
  }
  return value * signal.factor + signal.offset;
}

void put_physical_value(const DbcSignal& signal, double value, std::span<std::uint8_t> data) {
  CELLMIRROR_EXPECTS(data.size() >= bytes_needed(signal));
  const double scaled = (value - signal.offset) / signal.factor;
  std::uint64_t raw = 0;
  if (signal.type == DbcValueType::float32) {
    raw = std::bit_cast<std::uint32_t>(static_cast<float>(scaled));
  } else if (signal.type == DbcValueType::float64) {
    raw = std::bit_cast<std::uint64_t>(scaled);
  } else {
    const int bits = signal.length - (signal.is_signed ? 1 : 0);
    const double top = std::ldexp(1.0, bits);
    const double low = signal.is_signed ? -top : 0.0;
    const double rounded = std::isfinite(scaled) ? std::round(scaled) : 0.0;
    if (rounded >= top) {
      raw = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    } else if (rounded <= low) {
      raw = signal.is_signed ? ~std::uint64_t{0} << bits : 0;
    } else {
      raw = rounded < 0 ? static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded))
                        : static_cast<std::uint64_t>(rounded);
    }
  }
  if (signal.order == ByteOrder::little_endian) {
    put_bits(data, signal.start, signal.length, raw);
    return;
  }
  std::size_t bit = signal.start;
  for (std::size_t i = signal.length; i-- > 0;) {
    put_bits(data, bit, 1, raw >> i & 1U);
    bit = next_lower(bit);
  }
}

}  // namespace cellmirror::can
