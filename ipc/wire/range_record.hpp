// Records of ultrasonic sensors (SENSOR channel, SET_USSPAR): one reading a record (send mode 0), or the readings of
// all active sensors together (send mode 1), in as many records as they need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "ipc/wire/record.hpp"
#include "ipc/wire/record_fields.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror {

inline constexpr std::uint32_t kRangeSeen = 1;         // something is in the cone
inline constexpr std::uint32_t kRangeInBlindZone = 2;  // nearer than a real sensor can measure
inline constexpr std::uint32_t kRangeDoubtful = 4;     // something nearer may be there

namespace range_record_offset {
// From the start of the record.
inline constexpr std::size_t kId = 40;          // char[64]
inline constexpr std::size_t kObject = 104;     // char[128]
inline constexpr std::size_t kDistance = 232;   // f64
inline constexpr std::size_t kRange = 240;      // f64
inline constexpr std::size_t kBlindZone = 248;  // f64
inline constexpr std::size_t kHalfAngle = 256;  // f64
inline constexpr std::size_t kPoint = 264;      // f64[3]
inline constexpr std::size_t kFlags = 288;      // u32
inline constexpr std::size_t kReserved = 292;   // u32, 0
inline constexpr std::size_t kBytes = 296;
}  // namespace range_record_offset

namespace range_array_offset {
// From the start of the record.
inline constexpr std::size_t kPart = 40;    // u16, from 1
inline constexpr std::size_t kParts = 42;   // u16
inline constexpr std::size_t kCount = 44;   // u16, in this record
inline constexpr std::size_t kTotal = 46;   // u16, in all parts together
inline constexpr std::size_t kRanges = 48;  // first entry
// From the start of an entry.
inline constexpr std::size_t kEntryId = 0;          // char[64]
inline constexpr std::size_t kEntryDistance = 64;   // f64
inline constexpr std::size_t kEntryRange = 72;      // f64
inline constexpr std::size_t kEntryPoint = 80;      // f64[3]
inline constexpr std::size_t kEntryFlags = 104;     // u32
inline constexpr std::size_t kEntryReserved = 108;  // u32, 0
inline constexpr std::size_t kEntryBytes = 112;
}  // namespace range_array_offset

inline constexpr std::size_t kMaxRangesInRecord =
    (kMaxRecordBytes - range_array_offset::kRanges) / range_array_offset::kEntryBytes;
static_assert(kMaxRangesInRecord >= 64, "the sensors of a large cell fit in one record");

// Distance and point are NaN without an echo.
struct RangeRecord {
  RecordHeader header;
  std::string id;
  std::string object;                                          // dotted path of the detected body
  double distance = std::numeric_limits<double>::quiet_NaN();  // m, from the apex
  double range = 0;                                            // m
  double blind_zone = 0;                                       // m
  double half_angle = 0;                                       // rad
  PointRecord point{};
  bool in_blind_zone = false;
  bool doubtful = false;
};

struct RangeEntry {
  std::string id;
  double distance = std::numeric_limits<double>::quiet_NaN();  // m
  double range = 0;                                            // m
  PointRecord point{};
  bool in_blind_zone = false;
  bool doubtful = false;
};

struct RangeArrayRecord {
  RecordHeader header;
  std::uint16_t part = 1;
  std::uint16_t parts = 1;
  std::uint16_t total = 0;
  std::vector<RangeEntry> ranges;  // of this part
};

// What a record says of `reading`; sequence and wall time stay for the sender to fill in.
[[nodiscard]] RangeRecord range_record_of(const RangeReading& reading);
// The parts that hold all `readings`, kMaxRangesInRecord each and the rest; none for no readings. `readings`: of one
// posture, at most 65,535. Sequence and wall time stay for the sender to fill in.
[[nodiscard]] std::vector<RangeArrayRecord> range_arrays_of(std::span<const RangeReading> readings);

// As encode_robot_record: the length that was written; fails where `bytes` is too small (kMaxRecordBytes always
// suffices) and for numbers that contradict each other.
[[nodiscard]] Result<std::size_t> encode_range_record(const RangeRecord& record, std::span<std::byte> bytes);
[[nodiscard]] Result<std::size_t> encode_range_array(const RangeArrayRecord& record, std::span<std::byte> bytes);

// Strict: whatever the encoder would not write is refused.
[[nodiscard]] Result<RangeRecord> decode_range_record(std::span<const std::byte> bytes);
[[nodiscard]] Result<RangeArrayRecord> decode_range_array(std::span<const std::byte> bytes);

}  // namespace cellmirror
