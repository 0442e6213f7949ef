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
inline constexpr std::uint32_t kHapticBlockMagic = 0x50484D43;  // the bytes "CMHP"
inline constexpr std::size_t kLeastHapticBytes = 12;            // force only, as in 1999

// `memory` is shared with other processes and aligned to 8 bytes (one that is not holds nothing); whatever they write
// there is only ever read by value. Smaller memories hold what fits: below kSize no samples and nothing behind the
// joint torques, and of these the whole float32 values that fit. All functions: bounded time, no system call; SI.

// Gateway: once, before the first force. Makes all forces zero and leaves the device's section as it is. `joint_count`
// is that of the robot, at most kMaxJointsPerRobot (more counts as that); `process` the gateway's number.
void prepare_haptic_block(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process) CELL_RT;
// Gateway: rewrites the bytes 128 to 143 if they differ from those of prepare_haptic_block() (the memory was renewed,
// or overwritten). True if it did. Otherwise costs two loads: for each tick.
bool restore_haptic_header(std::span<std::byte> memory, std::uint8_t joint_count, std::uint32_t process) CELL_RT;
// Gateway, each tick. Forces and torques of which any is not finite, as float32 where it is written as such, are all
// written as zero, with the fault not_finite if `output` has none. The caller counts the sequence.
void write_haptic_output(std::span<std::byte> memory, const HapticOutput& output) CELL_RT;
// Gateway, at its end: all forces zero, phase closed, and the gateway's process number 0.
void end_haptic_block(std::span<std::byte> memory) CELL_RT;
// Gateway: `last` is the device's lock as of the last call that gave `fresh` (0 at first); it is updated. Tries
// shared_words::kTries times. `sample` changes only with `fresh`, and holds the device's numbers as they are: finite or
// not, of whatever length the quaternion. A time before 0 is read as 0, "never". A number of axes beyond kMaxHapticAxes
// gives no axes and a sample that is not valid.
[[nodiscard]] HapticRead read_haptic_sample(std::span<const std::byte> memory, std::uint64_t& last,
                                            HapticSample& sample) CELL_RT;

// Device's side, for simulators and tests: the sample as it is, faults and all (axes beyond kMaxHapticAxes are cut).
// Nothing is written into a memory below kSize.
void write_haptic_sample(std::span<std::byte> memory, const HapticSample& sample) CELL_RT;
// False where it was torn in every try, or the memory holds no block of this version. Leaves `output` alone then. Of
// force_E and joint_torques it gives the float32 values.
[[nodiscard]] bool read_haptic_output(std::span<const std::byte> memory, HapticOutput& output) CELL_RT;
// The process number of the gateway that writes; 0 where none does or the memory holds no block of this version.
[[nodiscard]] std::uint32_t haptic_block_gateway(std::span<const std::byte> memory) CELL_RT;

}  // namespace cellmirror
