// Record of a light barrier (SENSOR channel).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ipc/wire/record.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/light_barrier.hpp"

namespace cellmirror {

inline constexpr std::uint32_t kBarrierInterrupted = 1;
inline constexpr std::uint32_t kBarrierDoubtful = 2;

namespace barrier_record_offset {
// From the start of the record.
inline constexpr std::size_t kId = 40;              // char[64]
inline constexpr std::size_t kObject = 104;         // char[128]
inline constexpr std::size_t kInterruptions = 232;  // u64
inline constexpr std::size_t kFlags = 240;          // u32
inline constexpr std::size_t kReserved = 244;       // u32, 0
inline constexpr std::size_t kBytes = 248;
}  // namespace barrier_record_offset

struct BarrierRecord {
  RecordHeader header;
  std::string id;
  std::string object;               // a body in the beam; empty: none, or not known
  std::uint64_t interruptions = 0;  // since the start of the gateway
  bool interrupted = false;
  bool doubtful = false;
};

// The sender fills in sequence and wall time.
[[nodiscard]] BarrierRecord barrier_record_of(const BarrierReading& reading);

// The length that was written; fails where `bytes` is too small.
[[nodiscard]] Result<std::size_t> encode_barrier_record(const BarrierRecord& record, std::span<std::byte> bytes);
// Strict: whatever the encoder would not write is refused.
[[nodiscard]] Result<BarrierRecord> decode_barrier_record(std::span<const std::byte> bytes);

}  // namespace cellmirror
