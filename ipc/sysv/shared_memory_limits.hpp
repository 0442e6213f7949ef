// Limits of System V shared memory on this machine, and leftover segments, for `cellmirror doctor`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ipc/sysv/limits.hpp"

namespace cellmirror {

// The kernel's limits of this IPC namespace; 0 where unreadable.
struct SharedMemoryLimits {
  std::uint64_t max_segment_bytes = 0;  // shmmax
  std::uint64_t max_total_pages = 0;    // shmall
  std::uint64_t max_segments = 0;       // shmmni
  std::uint64_t segments_in_use = 0;
  std::uint64_t bytes_in_use = 0;
};
[[nodiscard]] SharedMemoryLimits read_shared_memory_limits(const std::filesystem::path& root = "/");

// A segment of this user without attached processes whose creator has ended.
struct LeftSegment {
  std::int32_t key = 0;
  std::int32_t id = 0;
  std::uint64_t bytes = 0;
};
// From /proc/sysvipc/shm; at most 64. Those of `user` only.
[[nodiscard]] std::vector<LeftSegment> read_left_segments(std::uint32_t user, const std::filesystem::path& root = "/");

// "shmmax", "shmall", "shmmni", "shared memory left behind".
[[nodiscard]] std::vector<IpcFinding> shared_memory_findings(const SharedMemoryLimits& limits,
                                                             const std::vector<LeftSegment>& left);

}  // namespace cellmirror
