// The records of the SENSOR channel (key 1990, message type 5): a fixed header and a payload, little-endian, described
// byte by byte in docs/messages.md. Codecs are pure: bytes in, values out; no clock, no queue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr long kSensorMessageType = 5;
inline constexpr std::size_t kMaxRecordBytes = 8192;        // a System V message by default; the header is part of it
inline constexpr std::uint32_t kRecordMagic = 0x5249'4D43;  // the bytes "CMIR"
inline constexpr std::uint16_t kRecordVersion = 1;
inline constexpr std::size_t kRecordNameBytes = 64;   // a name with at least one NUL behind it
inline constexpr std::size_t kRecordPathBytes = 128;  // a dotted path, likewise

// A number that was given out keeps its meaning for ever.
enum class RecordKind : std::uint16_t {
  robot_parameters = 1,
  ultrasonic_range = 2,
  ultrasonic_range_array = 3,
  camera_parameters = 4,
  proximity = 5,
  proximity_event = 6,
  tissue_event = 7,
  light_barrier = 8,
};

// Byte offsets of the header's fields.
namespace record_offset {
inline constexpr std::size_t kMagic = 0;         // u32
inline constexpr std::size_t kVersion = 4;       // u16
inline constexpr std::size_t kKind = 6;          // u16
inline constexpr std::size_t kLength = 8;        // u32, the whole record
inline constexpr std::size_t kReserved = 12;     // u32, 0
inline constexpr std::size_t kSequence = 16;     // u64
inline constexpr std::size_t kTime = 24;         // i64
inline constexpr std::size_t kWallTime = 32;     // i64
inline constexpr std::size_t kHeaderBytes = 40;  // where the payload starts
}  // namespace record_offset

struct RecordHeader {
  RecordKind kind = RecordKind::robot_parameters;
  std::uint32_t length = 0;       // bytes of the whole record
  std::uint64_t sequence = 0;     // counts the records of one channel from 1; a gap gives the number dropped
  std::int64_t time_ns = 0;       // CLOCK_MONOTONIC, the instant that the record shows
  std::int64_t wall_time_ns = 0;  // the same instant since 1970, for logs; may jump when the clock is set
};

// The header of a record of this version, of a kind that has a number and of exactly the length that it states. Fails
// for everything else.
[[nodiscard]] Result<RecordHeader> decode_record_header(std::span<const std::byte> record);

// Writes the header, whose length is record.size(). `record` holds at least kHeaderBytes.
void encode_record_header(const RecordHeader& header, std::span<std::byte> record);

}  // namespace cellmirror
