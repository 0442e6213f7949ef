#include "ipc/record/byte_stream.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace cellmirror::mcap {
namespace {

class RecordFiles : public testing::Test {
 protected:
  RecordFiles() {
    std::string pattern = (std::filesystem::temp_directory_path() / "record.XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~RecordFiles() override { std::filesystem::remove_all(folder_); }
  static Result<void> write(Sink& to, std::string_view text) {
    const View piece = view_of(text);
    return to.write(std::span(&piece, 1));
  }
  static std::string content(const std::filesystem::path& file) {
    std::stringstream out;
    out << std::ifstream(file, std::ios::binary).rdbuf();
    return out.str();
  }

  std::filesystem::path folder_;
};

TEST_F(RecordFiles, AFileIsItsOwnersAndReplacesNone) {
  auto made = FileSink::create(folder_ / "a.mcap");
  ASSERT_TRUE(made);
  struct stat info{};
  ASSERT_EQ(::stat((folder_ / "a.mcap").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
  const auto second = FileSink::create(folder_ / "a.mcap");
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("another name"), std::string::npos);
  EXPECT_FALSE(FileSink::create(folder_ / "none" / "a.mcap"));
}

TEST_F(RecordFiles, PiecesFollowEachOther) {
  auto made = FileSink::create(folder_ / "a.mcap");
  ASSERT_TRUE(made);
  const std::array<View, 3> pieces = {view_of("one "), View{}, view_of("two")};
  ASSERT_TRUE((*made)->write(pieces));
  ASSERT_TRUE(write(**made, " three"));
  EXPECT_EQ(content(folder_ / "a.mcap"), "one two three");
}

TEST_F(RecordFiles, AFailedWriteLeavesNoPartOfItself) {
  auto made = FileSink::create(folder_ / "a.mcap");
  ASSERT_TRUE(made);
  ASSERT_TRUE(write(**made, "whole"));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const old = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{10, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Result<void> written = write(**made, "more than fits");
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  EXPECT_FALSE(written);
  EXPECT_EQ(content(folder_ / "a.mcap"), "whole");
  EXPECT_TRUE(write(**made, " again"));
  EXPECT_EQ(content(folder_ / "a.mcap"), "whole again");
}

TEST_F(RecordFiles, ARemovedFileIsNoticed) {
  auto made = FileSink::create(folder_ / "a.mcap");
  ASSERT_TRUE(made);
  EXPECT_TRUE((*made)->still_there());
  std::filesystem::remove(folder_ / "a.mcap");
  EXPECT_FALSE((*made)->still_there());
}

TEST_F(RecordFiles, OnlyFilesAreRead) {
  EXPECT_FALSE(FileSource::open(folder_));
  EXPECT_FALSE(FileSource::open(folder_ / "none"));
  std::ofstream(folder_ / "a") << "0123456789";
  const auto source = FileSource::open(folder_ / "a");
  ASSERT_TRUE(source);
  EXPECT_EQ((*source)->size(), 10U);
  std::array<std::byte, 4> part;
  ASSERT_TRUE((*source)->read(3, part));
  EXPECT_EQ(part[0], std::byte{'3'});
  EXPECT_FALSE((*source)->read(7, part));
}

}  // namespace
}  // namespace cellmirror::mcap
