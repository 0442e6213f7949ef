#include "app/wall/wall_memory.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace cellmirror::app {
namespace {

const std::vector<RememberedCell> kCells = {{"A", "host", "default", 1'800'000'000'000'000'000}, {"B\n\"", "", "x", 5}};

TEST(WallMemory, IsReadAsItWasWritten) {
  const auto read = parse_wall_memory(wall_memory_text(kCells));
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, kCells);
}

TEST(WallMemory, LeavesOutWhatCannotBe) {
  const auto read = parse_wall_memory(
      R"({"format":1,"cells":[7,{"cell":"A"},{"cell":"","last_heard_ns":5},{"cell":"C","last_heard_ns":-1},
          {"cell":"D","last_heard_ns":18446744073709551615},{"cell":"E","last_heard_ns":1e3},{"cell":"F","last_heard_ns":7}]})");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 1u);
  EXPECT_EQ((*read)[0].cell, "F");
}

TEST(WallMemory, RefusesOtherDocuments) {
  for (const char* text : {"", "[]", "{}", R"({"format":2,"cells":[]})", R"({"format":1,"cells":{}})", "{\"format\":1"})
    EXPECT_FALSE(parse_wall_memory(text)) << text;
}

TEST(WallMemory, IsAFileOfItsOwnerAlone) {
  const auto folder = std::filesystem::temp_directory_path() / ("cellmirror-wall-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "wall.json";
  const auto none = read_wall_memory(file);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
  ASSERT_TRUE(write_wall_memory(file, kCells));
  ASSERT_TRUE(write_wall_memory(file, kCells));
  struct stat facts{};
  ASSERT_EQ(::stat(file.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0600U);
  EXPECT_EQ(*read_wall_memory(file), kCells);
  const auto failed = write_wall_memory(folder / "none" / "wall.json", kCells);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().text().find("--state"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cellmirror::app
