// The shared memory between the gateway and the process of a haptic device (rob_ela_shm, manual 1.2.6). A program of
// 1999 reads the first bytes only: float32 values, force x, y, z [N] in the end-effector frame, then the joint torques
// [Nm]. Everything behind them is ours: docs/shared-memory.md. Little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/ports/haptic_device.hpp"

namespace cellmirror {

namespace haptic_block_offset {
inline constexpr std::size_t kForce = 0;         // f32[3]
inline constexpr std::size_t kJointTorque = 12;  // f32[16]; those of joints that the robot has, the rest 0
inline constexpr std::size_t kMagic = 128;       // "CMHP"
inline constexpr std::size_t kVersion = 132;     // u16, 1
inline constexpr std::size_t kJointCount = 134;  // u16
inline constexpr std::size_t kBytes = 136;       // u32, 512
inline constexpr std::size_t kGateway = 140;     // u32, process id; 0 after the gateway has ended in good order
// Written by the gateway, together with the values at 0: odd while it is writing.
inline constexpr std::size_t kForceLock = 144;      // u64
inline constexpr std::size_t kForceSequence = 152;  // u64, from 1
inline constexpr std::size_t kForceTime = 160;      // i64, ns, CLOCK_MONOTONIC
inline constexpr std::size_t kPeriod = 168;         // i64, ns
inline constexpr std::size_t kAnswers = 176;        // u64, sequence of the sample that the force was computed from
inline constexpr std::size_t kPhase = 184;          // u32, HapticPhase
inline constexpr std::size_t kFault = 188;          // u32, HapticFault
inline constexpr std::size_t kForceD = 192;         // f64[3], N, in the device's base frame
inline constexpr std::size_t kTorqueD = 216;        // f64[3], Nm
inline constexpr std::size_t kGripperTorque = 240;  // f64, Nm
inline constexpr std::size_t kMaxForce = 248;       // f64, N
// Written by the device's process: odd while it is writing.
inline constexpr std::size_t kDeviceLock = 320;      // u64
inline constexpr std::size_t kDeviceSequence = 328;  // u64, from 1
inline constexpr std::size_t kDeviceTime = 336;      // i64, ns, CLOCK_MONOTONIC
inline constexpr std::size_t kDeviceProcess = 344;   // u32, process id
inline constexpr std::size_t kDeviceFlags = 348;     // u32, bit 0: the values are good
inline constexpr std::size_t kButtons = 352;         // u32
inline constexpr std::size_t kAxisCount = 356;       // u32, 0 to 7
inline constexpr std::size_t kPosition = 360;        // f64[3], m
inline constexpr std::size_t kOrientation = 384;     // f64[4], quaternion x y z w
inline constexpr std::size_t kGripper = 416;         // f64, rad
inline constexpr std::size_t kAxes = 424;            // f64[7], rad or m
inline constexpr std::size_t kSize = 512;
}  // namespace haptic_block_offset

inline constexpr std::uint16_t kHapticBlockVersion = 1;
inline constexpr std::size_t kLeastHapticBytes = 12;  // force only, as in 1999

// `memory` is shared with other processes, aligned to 8 bytes; whatever they write there is only ever read by value.
// Smaller memories hold what fits: below kSize no samples and nothing behind the joint torques.

// Gateway: once, before the first force. Leaves a device's section as it is.
void prepare_haptic_block(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process);
// Gateway, each tick.
void write_haptic_output(std::span<std::byte> memory, const HapticOutput& output) CELL_RT;
// Gateway: `last` is the device's lock as of the last call that gave `fresh`; it is updated. Tries a few times.
[[nodiscard]] HapticRead read_haptic_sample(std::span<const std::byte> memory, std::uint64_t& last,
                                            HapticSample& sample) CELL_RT;

// Device's side, for simulators and tests.
void write_haptic_sample(std::span<std::byte> memory, const HapticSample& sample) CELL_RT;
// False where it was torn in every try, or the memory holds no block of this version.
[[nodiscard]] bool read_haptic_output(std::span<const std::byte> memory, HapticOutput& output) CELL_RT;

}  // namespace cellmirror
