// Process data objects (CiA 301, 7.2.2): what a mapping puts where in a frame, at bit level. Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

inline constexpr std::size_t kMaxPdoEntries = 64;
inline constexpr std::size_t kMaxPdoBits = 64;

struct PdoValue {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t bits = 0;
  std::uint64_t raw = 0;  // zero extended
  bool operator==(const PdoValue&) const = default;
};

[[nodiscard]] std::size_t pdo_bits(std::span<const PdoEntryConfig> entries);
// Bytes of the frame: the bits rounded up.
[[nodiscard]] std::size_t pdo_length(std::span<const PdoEntryConfig> entries);
// At most kMaxPdoEntries entries of 1..64 bits, at most kMaxPdoBits together.
[[nodiscard]] bool is_valid_mapping(std::span<const PdoEntryConfig> entries);

// Where an object lies in the frame; none where the mapping does not hold it.
struct PdoField {
  std::size_t first_bit = 0;
  std::uint8_t bits = 0;
};
[[nodiscard]] std::optional<PdoField> find_in_mapping(std::span<const PdoEntryConfig> entries, std::uint16_t index,
                                                      std::uint8_t subindex);

// The values in the order of the mapping, fillers left out. None where the length of the data differs from the
// mapping's: then the sender has another mapping, and every value would be a wrong one. `entries` is a valid mapping.
[[nodiscard]] std::optional<std::vector<PdoValue>> unpack_pdo(std::span<const PdoEntryConfig> entries,
                                                              std::span<const std::uint8_t> data);
// The inverse: `values` in the order of the mapping without fillers (which become zero). Cuts each to its bits.
// 11-bit identifier unless cob_id has kCobIdExtended; the other flag bits are ignored.
[[nodiscard]] CanFrame pack_pdo(std::uint32_t cob_id, std::span<const PdoEntryConfig> entries,
                                std::span<const std::uint64_t> values);

// Objects 0x1600.. and 0x1A00..: index, subindex, bits in one word.
[[nodiscard]] std::uint32_t mapping_word(const PdoEntryConfig& entry);
// Indices below 0x20 are data types used as fillers: they become index 0.
[[nodiscard]] PdoEntryConfig entry_of_mapping_word(std::uint32_t word);

}  // namespace cellmirror::can
