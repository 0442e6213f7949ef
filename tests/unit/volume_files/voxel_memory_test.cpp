#include "config/volume/voxel_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace cellmirror {
namespace {

// VmLck of this process, KiB.
long locked_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    long kib = 0;
    if (word == "VmLck:" && status >> kib) return kib;
  }
  return -1;
}

VolumeData volume_of(std::size_t bytes) {
  VolumeData out;
  out.grid.values = std::vector<std::uint8_t>(bytes, 1);
  return out;
}

// 0: as it should be; else the number of the check that failed, 77 where memory cannot be locked here.
int in_a_process_that_locks_its_memory() {
  constexpr std::size_t kBytes = std::size_t{16} << 20U;
  constexpr long kKib = 16 << 10;
  const auto before = share_volume(volume_of(kBytes));
  if (mlockall(MCL_CURRENT) != 0 || mlockall(MCL_FUTURE | MCL_ONFAULT) != 0) return 77;
  const long with_voxels = locked_kib();
  exempt_voxels_from_locking();
  if (with_voxels - locked_kib() < kKib - 16) return 1;
  const long without = locked_kib();
  auto later = share_volume(volume_of(kBytes));
  if (locked_kib() - without > kKib / 2) return 2;
  later.reset();
  return before->grid.values.index() == 0 ? 0 : 3;
}

TEST(VoxelMemory, IsNotLockedWithTheRestOfTheProcess) {
#ifdef CELLMIRROR_SANITIZED
  GTEST_SKIP() << "skipped: sanitizers turn mlockall off";
#endif
  const pid_t child = fork();
  if (child == 0) _exit(in_a_process_that_locks_its_memory());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "skipped: memory cannot be locked here";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace cellmirror
