#include "app/io/record_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

class RecordFileTest : public testing::Test {
 protected:
  RecordFileTest() : folder_(fs::temp_directory_path() / ("cellmirror-records-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~RecordFileTest() override { fs::remove_all(folder_); }

  static std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string unpacked(const fs::path& file) {
    const gzFile in = ::gzopen(file.c_str(), "rb");
    std::string out;
    std::array<char, 4096> chunk{};
    for (int got = 0; (got = ::gzread(in, chunk.data(), chunk.size())) > 0;)
      out.append(chunk.data(), static_cast<std::size_t>(got));
    return ::gzclose(in) == Z_OK ? out : "broken";
  }
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.insert(entry.path().filename());
    return out;
  }

  fs::path folder_;
};

TEST_F(RecordFileTest, IsThereWhenItIsWholeAndForItsOwnerOnly) {
  {
    auto sut = RecordFile::create(folder_ / "a.jsonl");
    ASSERT_TRUE(sut) << sut.error().text();
    ASSERT_TRUE(sut->write("one\n"));
    EXPECT_EQ(names(), std::set<std::string>{"a.jsonl.part"});
    ASSERT_TRUE(sut->finish());
  }
  EXPECT_EQ(names(), std::set<std::string>{"a.jsonl"});
  EXPECT_EQ(text_of(folder_ / "a.jsonl"), "one\n");
  struct stat info{};
  ASSERT_EQ(::stat((folder_ / "a.jsonl").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777u, 0600u);
}

TEST_F(RecordFileTest, IsCompressedWhereItsNameSaysSo) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "{\"tick\":" + std::to_string(i) + "}\n";
  auto sut = RecordFile::create(folder_ / "a.jsonl.gz");
  ASSERT_TRUE(sut);
  for (std::size_t at = 0; at < text.size(); at += 65'536)
    ASSERT_TRUE(sut->write(std::string_view(text).substr(at, 65'536)));
  ASSERT_TRUE(sut->finish());
  EXPECT_EQ(unpacked(folder_ / "a.jsonl.gz"), text);
  EXPECT_LT(fs::file_size(folder_ / "a.jsonl.gz"), text.size() / 4);
}

TEST_F(RecordFileTest, ALinkInPlaceOfThePartIsRemovedAndNotFollowed) {
  std::ofstream(folder_ / "target") << "mine";
  fs::create_symlink(folder_ / "target", folder_ / "a.jsonl.part");
  auto sut = RecordFile::create(folder_ / "a.jsonl");
  ASSERT_TRUE(sut);
  ASSERT_TRUE(sut->write("one\n"));
  ASSERT_TRUE(sut->finish());
  EXPECT_EQ(text_of(folder_ / "target"), "mine");
  EXPECT_EQ(text_of(folder_ / "a.jsonl"), "one\n");
  EXPECT_FALSE(fs::is_symlink(folder_ / "a.jsonl"));
}

TEST_F(RecordFileTest, AFullDiskLeavesNothing) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit small{1000, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const char* name : {"a.jsonl", "a.jsonl.gz"}) {
    auto sut = RecordFile::create(folder_ / name);
    ASSERT_TRUE(sut);
    std::string noise;
    for (unsigned i = 0; i < 20'000; ++i) noise += static_cast<char>((i * i * 2'654'435'761u) >> 13);
    const bool written = sut->write(noise) && sut->finish();
    EXPECT_FALSE(written) << name;
    EXPECT_FALSE(sut->finish()) << "it stays failed";
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  EXPECT_EQ(names(), std::set<std::string>{});
}

TEST_F(RecordFileTest, WhatIsNotFinishedIsRemoved) {
  {
    auto sut = RecordFile::create(folder_ / "a.jsonl");
    ASSERT_TRUE(sut && sut->write("half"));
  }
  EXPECT_EQ(names(), std::set<std::string>{});
}

TEST_F(RecordFileTest, OldOnesAreRemovedByTheirNumberAndNothingElse) {
  for (const char* name : {"fault-9.jsonl", "fault-10.jsonl.gz", "fault-11.jsonl.gz", "fault-100.jsonl.gz",
                           "fault-7.jsonl.gz.part", "fault-mine.txt", "other-1.jsonl", "before_stop.jsonl"}) {
    std::ofstream(folder_ / name) << "x";
  }
  fs::create_directory(folder_ / "fault-1");
  EXPECT_EQ(remove_old_records(folder_, "fault-", 2), 3U);
  EXPECT_EQ(names(), (std::set<std::string>{"fault-11.jsonl.gz", "fault-100.jsonl.gz", "fault-mine.txt",
                                            "other-1.jsonl", "before_stop.jsonl", "fault-1"}));
  EXPECT_EQ(remove_old_records(folder_ / "missing", "fault-", 2), 0U);
}

}  // namespace
}  // namespace cellmirror::app
