#include "drivers/can/e2e/e2e.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint16_t top_of(std::uint8_t width) { return static_cast<std::uint16_t>(1U << (width - 1U)); }
constexpr std::uint16_t mask_of(std::uint8_t width) { return static_cast<std::uint16_t>((1UL << width) - 1UL); }

std::uint16_t add_byte(const CrcParameters& parameters, std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ (byte << (parameters.width - 8U)));
  for (int bit = 0; bit < 8; ++bit) {
    const bool top = (crc & top_of(parameters.width)) != 0;
    crc = static_cast<std::uint16_t>((crc << 1U) ^ (top ? parameters.polynomial : 0U));
  }
  return crc & mask_of(parameters.width);
}

std::size_t first_byte(const DbcSignal& signal) { return signal.start / 8U; }
std::size_t byte_count(const DbcSignal& signal) { return signal.length / 8U; }

// The bytes of the data id before and after the data.
struct DataId {
  std::array<std::uint8_t, 16> bytes{};
  std::size_t count = 0;
  bool first = false;

  void add(std::uint8_t byte) { bytes.at(count++) = byte; }
};

DataId data_id_for(const E2eFormat& format, std::uint16_t counter) {
  DataId id;
  switch (format.profile) {
    case E2eProfile::p01: {
      id.first = true;
      const bool high_only = format.data_id_mode == E2eDataIdMode::alternating && counter % 2 != 0;
      id.add(format.data_id[high_only ? 1 : 0]);
      if (format.data_id_mode == E2eDataIdMode::both) id.add(format.data_id[1]);
      if (format.data_id_mode == E2eDataIdMode::nibble) id.add(0);
      return id;
    }
    case E2eProfile::p02:
      id.add(format.data_id[counter % format.data_id.size()]);
      return id;
    case E2eProfile::p05:
    case E2eProfile::described:
      id.first = format.data_id_first;
      for (std::size_t i = 0; i < format.data_id_bytes; ++i) id.add(format.data_id[i]);
      return id;
  }
  return id;
}

std::uint16_t add_all(const CrcParameters& parameters, std::uint16_t crc, std::span<const std::uint8_t> data) {
  for (const std::uint8_t byte : data) crc = add_byte(parameters, crc, byte);
  return crc;
}

// Over the data but for the CRC's own bytes, and the data id.
std::uint16_t frame_crc(const E2eFormat& format, std::uint16_t counter, std::span<const std::uint8_t> data) {
  const DataId id = data_id_for(format, counter);
  const auto id_bytes = std::span(id.bytes).first(id.count);
  const std::size_t at = first_byte(format.crc_field);
  std::uint16_t crc = format.crc.initial & mask_of(format.crc.width);
  if (id.first) crc = add_all(format.crc, crc, id_bytes);
  crc = add_all(format.crc, crc, data.first(at));
  crc = add_all(format.crc, crc, data.subspan(at + byte_count(format.crc_field)));
  if (!id.first) crc = add_all(format.crc, crc, id_bytes);
  return (crc ^ format.crc.final_xor) & mask_of(format.crc.width);
}

DbcSignal field(std::uint16_t start, std::uint16_t length) {
  DbcSignal signal;
  signal.start = start;
  signal.length = length;
  return signal;
}

// As an integer, whatever the DBC says about scale and sign.
DbcSignal plain(const DbcSignal& signal) {
  DbcSignal out = field(signal.start, signal.length);
  out.order = signal.order;
  return out;
}

// Profile 1, variant 1A, 2 and 5: CRC first, then the counter (PRS_E2EProtocol; profile 1 in nibble mode has the high
// nibble of the data id beside the counter).
void set_layout(E2eFormat& format) {
  switch (format.profile) {
    case E2eProfile::p01:
      // The profile undoes the initial value and the inversion of the CRC library.
      format.crc = {.width = 8, .polynomial = kCrc8SaeJ1850.polynomial, .initial = 0, .final_xor = 0};
      format.last_counter = 14;
      break;
    case E2eProfile::p02:
      format.crc = kCrc8H2f;
      format.last_counter = 15;
      break;
    case E2eProfile::p05:
      format.crc = kCrc16Ccitt;
      format.crc_field = field(0, 16);
      format.counter_field = field(16, 8);
      format.last_counter = 255;
      return;
    case E2eProfile::described:
      return;
  }
  format.crc_field = field(0, 8);
  format.counter_field = field(8, 4);
}

Result<void> set_data_id(const E2eConfig& config, E2eFormat& format) {
  const bool one_number = config.profile == E2eProfile::p01 || config.profile == E2eProfile::p05;
  const std::size_t most = one_number ? 1 : format.data_id.size();
  const bool fits =
      config.profile == E2eProfile::described ? config.data_id.size() <= most : config.data_id.size() == most;
  if (!fits) return fail(fmt::format("data_id has {} numbers, the profile {}", config.data_id.size(), most));
  if (one_number) {
    format.data_id[0] = static_cast<std::uint8_t>(config.data_id[0] & 0xFFU);
    format.data_id[1] = static_cast<std::uint8_t>(config.data_id[0] >> 8U);
    format.data_id_bytes = 2;
    if (format.data_id_mode == E2eDataIdMode::nibble && format.data_id[1] > 0x0F)
      return fail("data_id has more than the 12 bits of the nibble mode");
    return {};
  }
  for (std::size_t i = 0; i < config.data_id.size(); ++i) {
    if (config.data_id[i] > 0xFF) return fail("data_id has a number beyond 255");
    format.data_id[i] = static_cast<std::uint8_t>(config.data_id[i]);
  }
  format.data_id_bytes = static_cast<std::uint8_t>(config.data_id.size());
  return {};
}

Result<const DbcSignal*> find_signal(const DbcMessage& message, const std::string& name) {
  if (const DbcSignal* signal = message.find(name)) return signal;
  std::vector<std::string> names;
  for (const DbcSignal& known : message.signals) names.push_back(known.name);
  return fail(fmt::format("the message {} has no signal {}", message.name, printable(name)), did_you_mean(name, names));
}

Result<void> set_described(const E2eConfig& config, const DbcMessage& message, E2eFormat& format) {
  const auto counter = find_signal(message, config.counter_signal);
  if (!counter) return std::unexpected(counter.error());
  const auto crc = find_signal(message, config.crc_signal);
  if (!crc) return std::unexpected(crc.error());
  if ((*counter)->length > 16) return fail(fmt::format("the counter {} has more than 16 bits", (*counter)->name));
  if ((*crc)->length != config.crc.width)
    return fail(fmt::format("{} has {} bits, crc_bits is {}", (*crc)->name, (*crc)->length, config.crc.width));
  const unsigned first_bit = (*crc)->order == ByteOrder::little_endian ? 0U : 7U;
  if ((*crc)->start % 8U != first_bit) return fail(fmt::format("{} lies across bytes", (*crc)->name));
  format.crc = config.crc;
  format.crc_field = plain(**crc);
  format.counter_field = plain(**counter);
  const auto all_bits = static_cast<std::uint16_t>((1UL << (*counter)->length) - 1UL);
  format.last_counter = config.last_counter == 0 ? all_bits : config.last_counter;
  if (format.last_counter > all_bits)
    return fail(fmt::format("{} cannot be as much as its last value", (*counter)->name));
  format.data_id_first = config.data_id_first;
  return {};
}

// Whether the counter lies in bytes of the CRC.
bool overlap(const E2eFormat& format) {
  std::array<std::uint8_t, 64> data{};
  // All of its bits, also those above its last value.
  const std::uint64_t all_bits = (std::uint64_t{1} << format.counter_field.length) - 1;
  put_physical_value(format.counter_field, static_cast<double>(all_bits), data);
  const auto of_crc = std::span(data).subspan(first_byte(format.crc_field), byte_count(format.crc_field));
  return std::ranges::any_of(of_crc, [](std::uint8_t byte) { return byte != 0; });
}

}  // namespace

std::uint16_t crc_of(const CrcParameters& parameters, std::span<const std::uint8_t> data) {
  const std::uint16_t crc = add_all(parameters, parameters.initial & mask_of(parameters.width), data);
  return (crc ^ parameters.final_xor) & mask_of(parameters.width);
}

std::string_view word(E2eStatus status) {
  constexpr std::array<std::string_view, 6> kStatusWords = {"ok",       "initial",        "ok, some lost",
                                                            "repeated", "wrong sequence", "wrong CRC"};
  return kStatusWords.at(static_cast<std::size_t>(status));
}

Result<E2eFormat> make_e2e_format(const E2eConfig& config, const DbcMessage& message) {
  E2eFormat format;
  format.profile = config.profile;
  format.data_id_mode = config.data_id_mode;
  format.max_delta = config.max_delta;
  set_layout(format);
  if (config.profile == E2eProfile::described) {
    if (auto set = set_described(config, message, format); !set) return std::unexpected(set.error());
  }
  if (auto set = set_data_id(config, format); !set) return std::unexpected(set.error());
  const std::size_t needed = std::max(bytes_needed(format.crc_field), bytes_needed(format.counter_field));
  if (needed > message.length)
    return fail(fmt::format("{} has {} bytes, its protection needs {}", message.name, message.length, needed));
  if (overlap(format)) return fail(fmt::format("the counter and the CRC of {} overlap", message.name));
  if (config.max_delta < 1 || config.max_delta >= format.last_counter)
    return fail(fmt::format("max_delta is {}, but has to be 1 to {}", config.max_delta, format.last_counter - 1));
  return format;
}

void protect(const E2eFormat& format, std::uint16_t counter, std::span<std::uint8_t> data) {
  put_physical_value(format.counter_field, counter, data);
  const bool nibble = format.profile == E2eProfile::p01 && format.data_id_mode == E2eDataIdMode::nibble;
  if (nibble) put_physical_value(field(12, 4), format.data_id[1], data);
  put_physical_value(format.crc_field, frame_crc(format, counter, data), data);
}

E2eChecker::Verdict E2eChecker::check(std::span<const std::uint8_t> data) {
  const auto counter = static_cast<std::uint16_t>(raw_value(format_.counter_field, data));
  const bool nibble = format_.profile == E2eProfile::p01 && format_.data_id_mode == E2eDataIdMode::nibble;
  const bool foreign = nibble && raw_value(field(12, 4), data) != format_.data_id[1];
  if (foreign || counter > format_.last_counter ||
      raw_value(format_.crc_field, data) != frame_crc(format_, counter, data))
    return {E2eStatus::wrong_crc, 0};
  if (!last_) {
    last_ = counter;
    return {E2eStatus::initial, 0};
  }
  const unsigned modulus = format_.last_counter + 1U;
  const auto delta = static_cast<std::uint16_t>((counter + modulus - *last_) % modulus);
  last_ = counter;
  if (delta == 0) return {E2eStatus::repeated, 0};
  const auto missing = static_cast<std::uint16_t>(delta - 1U);
  if (delta > format_.max_delta) return {E2eStatus::wrong_sequence, missing};
  return {delta == 1 ? E2eStatus::ok : E2eStatus::ok_some_lost, missing};
}

}  // namespace cellmirror::can
