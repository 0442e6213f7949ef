#include "ipc/sysv/limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::TemporaryFolder;

const IpcFinding& find(const std::vector<IpcFinding>& findings, std::string_view name) {
  return *std::find_if(findings.begin(), findings.end(), [&](const IpcFinding& f) { return f.name == name; });
}

TEST(SysvLimits, AreReadFromTheKernel) {
  const TemporaryFolder root;
  root.write("proc/sys/kernel/msgmax", "8192\n");
  root.write("proc/sys/kernel/msgmnb", "16384\n");
  root.write("proc/sys/kernel/msgmni", "32000\n");
  root.write("proc/sysvipc/msg", "key msqid\n1 2\n3 4\n");
  const SysvLimits sut = read_sysv_limits(root.path());
  EXPECT_EQ(sut.max_message_bytes, 8192u);
  EXPECT_EQ(sut.max_queue_bytes, 16384u);
  EXPECT_EQ(sut.max_queues, 32000u);
  EXPECT_EQ(sut.queues_in_use, 2u);
}

TEST(SysvLimits, OfThisMachineAreKnown) {
  const SysvLimits sut = read_sysv_limits();
  EXPECT_GT(sut.max_message_bytes, 0u);
  EXPECT_GT(sut.max_queue_bytes, 0u);
}

TEST(IpcFindings, TellWhatIsTooSmallAndTheCommandThatMendsIt) {
  const auto sut = ipc_findings({4096, 16384, 4, 2}, {});
  EXPECT_FALSE(find(sut, "msgmax").ok);
  EXPECT_EQ(find(sut, "msgmax").remedy, "sysctl -w kernel.msgmax=8192");
  EXPECT_TRUE(find(sut, "msgmnb").ok);
  EXPECT_EQ(find(sut, "msgmnb").remedy, "");
  EXPECT_FALSE(find(sut, "msgmni").ok);
  EXPECT_EQ(find(sut, "msgmni").remedy, "sysctl -w kernel.msgmni=5");
}

TEST(IpcFindings, RemoveIpcConcernsOrdinaryUsersOfLogindOnly) {
  RemoveIpc setting;
  setting.concerns_us = true;
  setting.logind_runs = true;
  EXPECT_FALSE(find(ipc_findings({}, setting), "RemoveIPC").ok);
  EXPECT_EQ(find(ipc_findings({}, setting), "RemoveIPC").value, "yes (default)");
  setting.concerns_us = false;
  EXPECT_TRUE(find(ipc_findings({}, setting), "RemoveIPC").ok);
}

TEST(RemoveIpcSetting, IsYesByDefault) {
  const TemporaryFolder root;
  const RemoveIpc sut = read_remove_ipc(root.path());
  EXPECT_TRUE(sut.enabled);
  EXPECT_EQ(sut.set_by, "");
  EXPECT_FALSE(sut.logind_runs);
  EXPECT_FALSE(sut.concerns_us);
}

TEST(RemoveIpcSetting, CommentsAndOtherSectionsSayNothing) {
  const TemporaryFolder root;
  root.write("etc/systemd/logind.conf",
             "#RemoveIPC=no\n[Other]\nRemoveIPC=no\n[Login]\n;RemoveIPC=no\nRemoveIPC=maybe\n");
  EXPECT_TRUE(read_remove_ipc(root.path()).enabled);
}

TEST(RemoveIpcSetting, LastDropInByNameWinsAndEtcHidesUsr) {
  const TemporaryFolder root;
  root.write("etc/systemd/logind.conf", "[Login]\nRemoveIPC=yes\n");
  root.write("usr/lib/systemd/logind.conf.d/50-site.conf", "[Login]\nRemoveIPC=yes\n");
  root.write("etc/systemd/logind.conf.d/50-site.conf", "[Login]\n RemoveIPC = No \n");
  root.write("run/systemd/logind.conf.d/10-early.conf", "[Login]\nRemoveIPC=yes\n");
  root.write("etc/systemd/logind.conf.d/notes.txt", "[Login]\nRemoveIPC=yes\n");
  const RemoveIpc sut = read_remove_ipc(root.path());
  EXPECT_FALSE(sut.enabled);
  EXPECT_EQ(sut.set_by, (root.path() / "etc/systemd/logind.conf.d/50-site.conf").native());
}

}  // namespace
}  // namespace cellmirror
