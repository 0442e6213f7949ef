#include "drivers/can/canopen/pdo.hpp"

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {

std::size_t pdo_bits(std::span<const PdoEntryConfig> entries) {
  std::size_t bits = 0;
  for (const PdoEntryConfig& entry : entries) bits += entry.bits;
  return bits;
}

std::size_t pdo_length(std::span<const PdoEntryConfig> entries) { return (pdo_bits(entries) + 7) / 8; }

bool is_valid_mapping(std::span<const PdoEntryConfig> entries) {
  if (entries.empty() || entries.size() > kMaxPdoEntries || pdo_bits(entries) > kMaxPdoBits) return false;
  for (const PdoEntryConfig& entry : entries) {
    if (entry.bits == 0 || entry.bits > 64) return false;
  }
  return true;
}

std::optional<PdoField> find_in_mapping(std::span<const PdoEntryConfig> entries, std::uint16_t index,
                                        std::uint8_t subindex) {
  std::size_t first_bit = 0;
  for (const PdoEntryConfig& entry : entries) {
    if (entry.index == index && entry.subindex == subindex) return PdoField{first_bit, entry.bits};
    first_bit += entry.bits;
  }
  return {};
}

std::optional<std::vector<PdoValue>> unpack_pdo(std::span<const PdoEntryConfig> entries,
                                                std::span<const std::uint8_t> data) {
  CELLMIRROR_EXPECTS(is_valid_mapping(entries));
  if (data.size() != pdo_length(entries)) return {};
  std::vector<PdoValue> values;
  values.reserve(entries.size());
  std::size_t first_bit = 0;
  for (const PdoEntryConfig& entry : entries) {
    if (entry.index != 0) {
      values.push_back({entry.index, entry.subindex, entry.bits, get_bits(data, first_bit, entry.bits)});
    }
    first_bit += entry.bits;
  }
  return values;
}

CanFrame pack_pdo(std::uint32_t cob_id, std::span<const PdoEntryConfig> entries,
                  std::span<const std::uint64_t> values) {
  CELLMIRROR_EXPECTS(is_valid_mapping(entries));
  CanFrame frame;
  frame.extended = (cob_id & kCobIdExtended) != 0;
  frame.id = cob_id & (frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
  frame.length = static_cast<std::uint8_t>(pdo_length(entries));
  std::size_t first_bit = 0;
  std::size_t next = 0;
  for (const PdoEntryConfig& entry : entries) {
    if (entry.index != 0) {
      CELLMIRROR_EXPECTS(next < values.size());
      put_bits(frame.data, first_bit, entry.bits, values[next++]);
    }
    first_bit += entry.bits;
  }
  return frame;
}

std::uint32_t mapping_word(const PdoEntryConfig& entry) {
  return std::uint32_t{entry.index} << 16 | std::uint32_t{entry.subindex} << 8 | entry.bits;
}

PdoEntryConfig entry_of_mapping_word(std::uint32_t word) {
  PdoEntryConfig entry;
  entry.index = static_cast<std::uint16_t>(word >> 16);
  entry.subindex = static_cast<std::uint8_t>(word >> 8);
  entry.bits = static_cast<std::uint8_t>(word);
  if (entry.index < 0x20) entry.index = 0;
  return entry;
}

}  // namespace cellmirror::can
