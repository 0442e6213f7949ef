// Shared memory 1313 (SET_EXT_TCP_TEST, SET_TORQUE_LIMIT; manual 1.2.4): the force at the TCP of the active robot. Four
// float32 as in 1999: force x, y, z [N] in the end-effector frame and the torque about the tool axis [Nm]; ours behind
// them (docs/shared-memory.md). Little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/base/fixed_text.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

inline constexpr std::int32_t kTcpForceKey = 1313;
inline constexpr std::uint32_t kTcpForceMagic = 0x46544D43;  // the bytes "CMTF"
inline constexpr std::uint16_t kTcpForceVersion = 1;

namespace tcp_force_block_offset {
inline constexpr std::size_t kValues = 0;     // f32[4]
inline constexpr std::size_t kMagic = 64;     // "CMTF"
inline constexpr std::size_t kVersion = 68;   // u16, 1
inline constexpr std::size_t kBytes = 70;     // u16, 192
inline constexpr std::size_t kLock = 72;      // u64, odd while it is being written, the values at 0 too
inline constexpr std::size_t kSequence = 80;  // u64, from 1
inline constexpr std::size_t kTime = 88;      // i64, ns, CLOCK_MONOTONIC
inline constexpr std::size_t kFlags = 96;     // u32
inline constexpr std::size_t kProcess = 100;  // u32, of the gateway
inline constexpr std::size_t kRobot = 104;    // char[64], zero-terminated: id of the robot
inline constexpr std::size_t kSize = 192;
}  // namespace tcp_force_block_offset

inline constexpr std::uint32_t kTcpForceValid = 1;        // the force at this robot's TCP is known
inline constexpr std::uint32_t kTcpForceTest = 2;         // the values of SET_EXT_TCP_TEST
inline constexpr std::uint32_t kTcpForceBeyondLimit = 4;  // of SET_TORQUE_LIMIT

struct TcpForce {
  std::array<float, 4> values{};
  std::uint64_t sequence = 0;
  Timestamp time;
  std::uint32_t flags = 0;
  std::uint32_t process = 0;
  FixedText<64> robot;
};

// `memory` is shared with other processes and aligned to 8 bytes (one that is not holds nothing). All functions: N and
// Nm, bounded time, no system call, no heap.

// One writer at a time. Memories below kSize hold as many of the four values as fit and nothing else. Values of which
// any is not finite are all written as zero, without kTcpForceValid. The robot's id is cut at 63 bytes. A gateway that
// ends writes a last time with flags and process 0.
void write_tcp_force(std::span<std::byte> memory, const TcpForce& force);
// Values, flags and process zero; the numbers continue, so that a reader that waits for another one sees the end.
void end_tcp_force(std::span<std::byte> memory);
// The process number of the gateway that writes; 0 where none does or the memory holds no block of this version.
[[nodiscard]] std::uint32_t tcp_force_process(std::span<const std::byte> memory);
// False where it was torn in every try, or is no block of this version; leaves `force` alone then.
[[nodiscard]] bool read_tcp_force(std::span<const std::byte> memory, TcpForce& force);

}  // namespace cellmirror
