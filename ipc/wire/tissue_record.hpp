// Records of events of deformable objects (SENSOR channel): what an instrument did to tissue, or what befell it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ipc/wire/record.hpp"
#include "ipc/wire/record_fields.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror {

namespace tissue_record_offset {
// From the start of the record.
inline constexpr std::size_t kEvent = 40;     // u64
inline constexpr std::size_t kKind = 48;      // u8, TissueEventKind
inline constexpr std::size_t kLimit = 49;     // u8, TissueLimit; 0 for other kinds
inline constexpr std::size_t kReserved = 50;  // 6 bytes, 0
inline constexpr std::size_t kValue = 56;     // f64
inline constexpr std::size_t kPlace = 64;     // f64[3]
inline constexpr std::size_t kRobot = 88;     // char[64]
inline constexpr std::size_t kObject = 152;   // char[64]
inline constexpr std::size_t kPart = 216;     // char[64]
inline constexpr std::size_t kBytes = 280;
}  // namespace tissue_record_offset

struct TissueRecord {
  RecordHeader header;
  std::uint64_t event = 0;  // from 1; a gap gives the number lost
  TissueEventKind kind{};
  TissueLimit limit{};  // of kind limit
  double value = 0;     // as TissueEvent::value
  PointRecord place{};
  std::string robot;   // empty: none
  std::string object;  // empty: none
  std::string part;    // empty: none
};

// The sender fills in sequence and wall time.
[[nodiscard]] TissueRecord tissue_record_of(const NamedTissueEvent& event);

// As encode_robot_record: the length that was written; fails where `bytes` is too small.
[[nodiscard]] Result<std::size_t> encode_tissue_record(const TissueRecord& record, std::span<std::byte> bytes);

// Strict: whatever the encoder would not write is refused. Numbers are passed on as they are, NaN too.
[[nodiscard]] Result<TissueRecord> decode_tissue_record(std::span<const std::byte> bytes);

}  // namespace cellmirror
