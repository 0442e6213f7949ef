#include "ipc/sysv/shared_memory_limits.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

#include "ipc/sysv/process_watch.hpp"
#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::TemporaryFolder;

// As the kernel has it, with its heading.
std::string table(std::initializer_list<std::string_view> lines) {
  std::string text = "       key      shmid perms       size  cpid  lpid nattch   uid   gid\n";
  for (const std::string_view line : lines) {
    text += line;
    text += '\n';
  }
  return text;
}

const IpcFinding& find(const std::vector<IpcFinding>& findings, std::string_view name) {
  return *std::find_if(findings.begin(), findings.end(), [&](const IpcFinding& f) { return f.name == name; });
}

TEST(SharedMemoryLimits, AreReadFromTheKernel) {
  const TemporaryFolder root;
  root.write("proc/sys/kernel/shmmax", "18446744073692774399\n");
  root.write("proc/sys/kernel/shmall", "4194304\n");
  root.write("proc/sys/kernel/shmmni", "4096\n");
  root.write("proc/sysvipc/shm", table({"1313 5 600 192 7 8 2 1000 1000", "0 6 600 4096 7 8 2 1000 1000"}));
  const SharedMemoryLimits sut = read_shared_memory_limits(root.path());
  EXPECT_EQ(sut.max_segment_bytes, 18446744073692774399u);
  EXPECT_EQ(sut.max_total_pages, 4194304u);
  EXPECT_EQ(sut.max_segments, 4096u);
  EXPECT_EQ(sut.segments_in_use, 2u);
  EXPECT_EQ(sut.bytes_in_use, 4288u);
}

TEST(SharedMemoryLimits, AreUnknownWhereNothingCanBeRead) {
  const TemporaryFolder root;
  EXPECT_EQ(find(shared_memory_findings(read_shared_memory_limits(root.path()), {}), "shmmax").value, "unknown");
}

// Left behind: of this user, with a key, nobody attached, made by a process that is gone. No process has number 0.
TEST(LeftSegments, AreThoseThatNobodyCanStillUse) {
  const TemporaryFolder root;
  std::string of_a_living_maker = "79 6 600 512 ";
  of_a_living_maker += std::to_string(::getpid());
  of_a_living_maker += " 8 0 1000 1000";
  const std::string_view ours = "1313 1 600 192 0 8 0 1000 1000";
  const std::string_view ours_negative = "-1329070079 2 600 512 0 8 0 1000 1000";
  const std::string_view attached = "77 3 600 512 0 8 1 1000 1000";
  const std::string_view of_another_user = "78 4 600 512 0 8 0 1001 1000";
  const std::string_view without_key = "0 5 1600 512 0 8 0 1000 1000";
  root.write("proc/sysvipc/shm",
             table({ours, ours_negative, attached, of_another_user, without_key, of_a_living_maker, "rubbish"}));
  const auto sut = read_left_segments(1000, root.path());
  ASSERT_EQ(sut.size(), 2u);
  EXPECT_EQ(sut[0].key, 1313);
  EXPECT_EQ(sut[0].id, 1);
  EXPECT_EQ(sut[0].bytes, 192u);
  EXPECT_EQ(sut[1].key, -1329070079);
}

TEST(SharedMemoryFindings, TellWhatIsTooSmallAndTheCommandThatMendsIt) {
  const auto sut = shared_memory_findings({4096, 1, 3, 2, 0}, {});
  EXPECT_EQ(find(sut, "shmmax").remedy, "sysctl -w kernel.shmmax=1048576");
  EXPECT_FALSE(find(sut, "shmall").ok);
  EXPECT_EQ(find(sut, "shmmni").remedy, "sysctl -w kernel.shmmni=8");
  EXPECT_TRUE(find(sut, "shared memory").ok);
}

TEST(SharedMemoryFindings, TellWhatWasLeftBehindAndHowToRemoveIt) {
  const auto sut = shared_memory_findings({}, {{1313, 5, 192}, {2, 6, 512}});
  EXPECT_FALSE(find(sut, "shared memory").ok);
  EXPECT_EQ(find(sut, "shared memory").value, "2 left by ended processes: 0x521 (1313), 0x2 (2)");
  EXPECT_TRUE(find(sut, "shared memory").remedy.starts_with("ipcrm -m 5 -m 6 ")) << find(sut, "shared memory").remedy;
}

TEST(ProcessWatch, KnowsProcessesByTheirNumbers) {
  EXPECT_TRUE(process_exists(static_cast<std::uint32_t>(::getpid())));
  EXPECT_TRUE(process_exists(1));
  EXPECT_FALSE(process_exists(0));
  EXPECT_FALSE(process_exists(0xffffffff)) << "would mean all processes";
  EXPECT_FALSE(process_exists(0x7fffffff));
}

TEST(ProcessWatch, ANumberThatWasNeverThereHasNotEnded) {
  ProcessWatch sut;
  EXPECT_FALSE(sut.has_ended(0));
  EXPECT_FALSE(sut.has_ended(0x7fffffff));
  EXPECT_FALSE(sut.has_ended(static_cast<std::uint32_t>(::getpid())));
}

}  // namespace
}  // namespace cellmirror
