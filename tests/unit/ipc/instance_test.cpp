#include "ipc/control/instance.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <string>

#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::PrivateRuntimeFolder;

InstanceInfo info_of(const std::string& name) { return {name, 0, "/cells/a b/cell.toml", default_queues(name)}; }

TEST(InstanceName, IsShortAndPlain) {
  for (const auto* name : {"default", "A", "cell_2-b", "0123456789012345678901234567890_"}) {
    EXPECT_TRUE(check_instance_name(name)) << name;
  }
  for (const auto* name : {"", ".", "..", ".locks", "a/b", "a b", "\xC3\xA9", "0123456789012345678901234567890_x"}) {
    EXPECT_FALSE(check_instance_name(name)) << name;
  }
}

TEST(InstanceKeys, DefaultHasTheManualsOnes) {
  const QueueConfig sut = default_queues("default");
  EXPECT_EQ(sut.script_key, 2351);
  EXPECT_EQ(sut.sensor_key, 1990);
  EXPECT_EQ(sut.reply_key, 2352);
  EXPECT_EQ(sut.tcp_force_key, 1313);
}

// 0xe40c292c is the published test vector of FNV-1a for "a".
TEST(InstanceKeys, OthersHaveKeysOfTheirOwn) {
  const QueueConfig sut = default_queues("a");
  EXPECT_EQ(sut.script_key, 0x434D0000 + 3 * static_cast<int>(0xe40c292cu % 21845u));
  EXPECT_EQ(sut.sensor_key, sut.script_key + 1);
  EXPECT_EQ(sut.reply_key, sut.script_key + 2);
  EXPECT_EQ(sut.tcp_force_key, 0x434E0000 + static_cast<int>(0xe40c292cu % 0x10000u));
}

TEST(InstanceKeys, StayInTheirRangeAndRarelyMeet) {
  std::set<std::int32_t> keys;
  for (int i = 0; i < 100; ++i) {
    const QueueConfig sut = default_queues("cell" + std::to_string(i));
    EXPECT_GE(sut.script_key, 0x434D0000);
    EXPECT_LE(sut.reply_key, 0x434DFFFF);
    keys.insert(sut.script_key);
  }
  EXPECT_GE(keys.size(), 98u);
}

TEST(InstanceKeys, CellFileWins) {
  QueueConfig from_cell;
  from_cell.sensor_key = 77;
  from_cell.mode = 0660;
  const QueueConfig sut = queues_of_instance("b", from_cell);
  EXPECT_EQ(sut.sensor_key, 77);
  EXPECT_EQ(sut.script_key, default_queues("b").script_key);
  EXPECT_EQ(sut.mode, 0660u);
  EXPECT_EQ(queues_of_instance("default", from_cell).script_key, 2351);
}

TEST(Instance, IsFoundWhileItRunsAndGoneAfterwards) {
  const PrivateRuntimeFolder environment;
  {
    const auto sut = Instance::claim(info_of("line_1"));
    ASSERT_TRUE(sut) << sut.error().text();
    EXPECT_EQ(sut->info().pid, ::getpid());
    const auto found = find_instance("line_1");
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_EQ(found->pid, ::getpid());
    EXPECT_EQ(found->cell, "/cells/a b/cell.toml");
    EXPECT_EQ(found->queues.script_key, default_queues("line_1").script_key);
    EXPECT_EQ(control_socket_of("line_1"), sut->control_socket());
    EXPECT_EQ(running_instances()->size(), 1u);
  }
  EXPECT_FALSE(std::filesystem::exists(environment.path() / "line_1"));
  const auto gone = find_instance("line_1");
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().what, "no gateway of the instance line_1 is running");
  EXPECT_NE(gone.error().remedy.find("--instance line_1"), std::string::npos);
  EXPECT_TRUE(running_instances()->empty());
}

TEST(Instance, SecondOfTheSameNameIsRefusedWithTheProcess) {
  const PrivateRuntimeFolder environment;
  const auto first = Instance::claim(info_of("default"));
  ASSERT_TRUE(first);
  const auto sut = Instance::claim(info_of("default"));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("process " + std::to_string(::getpid())), std::string::npos) << sut.error().text();
  EXPECT_TRUE(Instance::claim(info_of("other")));
  EXPECT_TRUE(find_instance("default")) << "the refused one must not take the first one's files away";
}

TEST(Instance, BadNamesAreRefused) {
  const PrivateRuntimeFolder environment;
  EXPECT_FALSE(Instance::claim(info_of("../evil")));
  EXPECT_FALSE(find_instance("../evil"));
  EXPECT_FALSE(control_socket_of("../evil"));
}

TEST(Instance, WhatAKilledOneLeftBehindIsTakenAway) {
  const PrivateRuntimeFolder environment;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto claimed = Instance::claim(info_of("killed"));
    if (claimed && ::write(ready[1], "y", 1) == 1) ::pause();
    _exit(1);
  }
  char ok = 'n';
  ASSERT_EQ(::read(ready[0], &ok, 1), 1);
  ::close(ready[0]);
  ::close(ready[1]);
  EXPECT_EQ(find_instance("killed")->pid, child);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);

  EXPECT_TRUE(std::filesystem::exists(environment.path() / "killed" / "instance.json"));
  EXPECT_FALSE(find_instance("killed"));
  EXPECT_TRUE(running_instances()->empty());
  EXPECT_FALSE(std::filesystem::exists(environment.path() / "killed"));
  EXPECT_TRUE(Instance::claim(info_of("killed")));
}

TEST(Instance, DamagedDescriptionIsAMessage) {
  const PrivateRuntimeFolder environment;
  const auto claimed = Instance::claim(info_of("odd"));
  ASSERT_TRUE(claimed);
  for (const auto* text : {"", "{", "[]", "{\"name\": 3}", "{\"name\":\"odd\",\"pid\":\"x\"}"}) {
    std::ofstream(claimed->folder() / "instance.json") << text;
    const auto sut = find_instance("odd");
    ASSERT_FALSE(sut) << text;
    EXPECT_FALSE(sut.error().remedy.empty());
  }
  EXPECT_TRUE(running_instances()) << "one bad description does not hide the others";
}

}  // namespace
}  // namespace cellmirror
