// The files of a cell in a recording and out of it again: each content once, bounds, and names that lead elsewhere.
#include "app/recording/recorded_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "app/recorder/cell_files.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/home.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint64_t kEnough = 1'000'000;

class RecordedCellTest : public testing::Test {
 protected:
  RecordedCellTest() : scratch_(*TemporaryFolder::make()) {
    fs::create_directories(home());
    fs::create_directories(home() / "envlib");
    for (const char* name : {"out", "other"}) {
      fs::create_directory(scratch_.path() / name);
      fs::permissions(scratch_.path() / name, fs::perms::owner_all);
    }
  }
  [[nodiscard]] fs::path home() const { return scratch_.path() / "cell"; }
  [[nodiscard]] fs::path out() const { return scratch_.path() / "out"; }
  fs::path write(const std::string& place, const std::string& content) const {
    std::ofstream(home() / place) << content;
    return home() / place;
  }
  // The files of the cell as a recording.
  std::vector<std::string> record(const CellFiles& cell, std::uint64_t most = kEnough) {
    mcap::Writer writer(recording_, {});
    EXPECT_TRUE(writer.begin());
    auto left_out = attach_cell_files(writer, cell, most, 1);
    EXPECT_TRUE(left_out) << left_out.error().text();
    EXPECT_TRUE(writer.finish());
    return left_out ? *left_out : std::vector<std::string>();
  }
  void record_by_hand(const std::map<std::string, std::string>& attachments, const mcap::Metadata& metadata) {
    mcap::Writer writer(recording_, {});
    ASSERT_TRUE(writer.begin());
    for (const auto& [name, content] : attachments)
      ASSERT_TRUE(writer.put(mcap::Attachment{1, 1, name, "application/toml", mcap::view_of(content)}));
    ASSERT_TRUE(writer.put(metadata));
    ASSERT_TRUE(writer.finish());
  }
  Result<ExtractedCell> extract(std::uint64_t most = kEnough) {
    const mcap::MemorySource source(recording_.bytes);
    const auto reader = mcap::Reader::open(source);
    EXPECT_TRUE(reader);
    return extract_cell(*reader, out(), most);
  }
  RecordedCell recorded() {
    const mcap::MemorySource source(recording_.bytes);
    const auto reader = mcap::Reader::open(source);
    EXPECT_TRUE(reader);
    return recorded_cell(*reader);
  }
  static std::string content(const fs::path& file) { return read_text_file(file, kEnough).value_or("?"); }
  static unsigned mode(const fs::path& file) {
    struct stat info{};
    EXPECT_EQ(::lstat(file.c_str(), &info), 0);
    return info.st_mode & 07777U;
  }
  [[nodiscard]] std::size_t entries(const fs::path& folder) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  TemporaryFolder scratch_;
  mcap::MemorySink recording_;
};

TEST_F(RecordedCellTest, AllFilesComeOutAsTheyWereAndEachContentIsThereOnce) {
  const CellFiles cell = cell_files(home(), {write("cell.toml", "name = 1"), write("envlib/a.mpc", "a"),
                                             write("envlib/a.stl", "mesh"), write("envlib/b.stl", "mesh")});
  EXPECT_THAT(record(cell), IsEmpty());
  const RecordedCell listed = recorded();
  EXPECT_TRUE(listed.complete());
  EXPECT_EQ(listed.files.at("envlib/b.stl"), "envlib/a.stl");
  const auto sut = extract();
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->cell_file, out() / "cell.toml");
  EXPECT_EQ(content(out() / "cell.toml"), "name = 1");
  EXPECT_EQ(content(out() / "envlib/a.mpc"), "a");
  EXPECT_EQ(content(out() / "envlib/a.stl"), "mesh");
  EXPECT_EQ(content(out() / "envlib/b.stl"), "mesh");
  EXPECT_EQ(mode(out() / "envlib/b.stl"), 0600U);
  EXPECT_EQ(mode(out() / "envlib"), 0700U);
}

TEST_F(RecordedCellTest, WhatIsLeftOutIsTold) {
  const fs::path elsewhere = scratch_.path() / "other" / "x.stl";
  std::ofstream(elsewhere) << "x";
  const CellFiles cell = cell_files(home(), {write("cell.toml", "name = 1"), write("envlib/large.stl", "0123456789"),
                                             write("envlib/small.stl", "1"), write("envlib/new.mpc", "2"), elsewhere});
  std::ofstream(home() / "envlib/new.mpc") << "another";
  const std::vector<std::string> sut = record(cell, 12);
  EXPECT_THAT(sut, ElementsAre(HasSubstr("envlib/large.stl: "), HasSubstr("envlib/new.mpc: it was changed"),
                               HasSubstr("x.stl: it is outside")));
  EXPECT_FALSE(recorded().complete());
  EXPECT_EQ(recorded().missing.size(), 3U);
  const auto extracted = extract();
  ASSERT_TRUE(extracted) << extracted.error().text();
  EXPECT_EQ(extracted->missing.size(), 3U);
  EXPECT_EQ(content(out() / "envlib/small.stl"), "1");
  EXPECT_FALSE(fs::exists(out() / "envlib/large.stl"));
}

TEST_F(RecordedCellTest, ACellFileFromElsewhereStandsInTheFolder) {
  const fs::path file = scratch_.path() / "other" / "mine.toml";
  std::ofstream(file) << "name = 2";
  record(cell_files(home(), {file, write("envlib/a.mpc", "a")}));
  const auto sut = extract();
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(content(sut->cell_file), "name = 2");
}

TEST_F(RecordedCellTest, NamesThatLeadOutOfTheFolderAreRefused) {
  for (const std::string name : {"../x", "/tmp/x", "a/../../x", "", "a//b", ".", "a/", "a\\b", "a\nb",
                                 "1/2/3/4/5/6/7/8/9/10/11/12/13/14/15/16/17/18"}) {
    recording_.bytes.clear();
    record_by_hand({{"cell.toml", "name = 1"}, {name, "x"}},
                   {std::string(kCellFilesName),
                    {{"cell", "cell.toml"}, {"file:cell.toml", "attached"}, {"file:" + name, "attached"}}});
    const auto sut = extract();
    EXPECT_FALSE(sut) << name;
    EXPECT_FALSE(fs::exists(scratch_.path() / "x"));
    fs::remove_all(out());
    fs::create_directory(out());
    fs::permissions(out(), fs::perms::owner_all);
  }
}

TEST_F(RecordedCellTest, AFileInPlaceOfAFolderAndMoreBytesThanAllowedAreRefused) {
  record_by_hand({{"a", "x"}, {"a/b", "y"}},
                 {std::string(kCellFilesName), {{"cell", "a"}, {"file:a", "attached"}, {"file:a/b", "attached"}}});
  EXPECT_FALSE(extract());
  recording_.bytes.clear();
  fs::remove(out() / "a");
  record_by_hand({{"a", "0123"}},
                 {std::string(kCellFilesName),
                  {{"cell", "a"}, {"file:a", "attached"}, {"file:b", "same as a"}, {"file:c", "same as a"}}});
  EXPECT_FALSE(extract(10));
}

TEST_F(RecordedCellTest, TheFolderHasToBePrivateAndEmptyAndNoLink) {
  record(cell_files(home(), {write("cell.toml", "name = 1")}));
  fs::permissions(out(), fs::perms::owner_all | fs::perms::group_read);
  EXPECT_FALSE(extract());
  fs::permissions(out(), fs::perms::owner_all);
  std::ofstream(out() / "there") << "x";
  EXPECT_FALSE(extract());
  fs::remove_all(out());
  fs::create_symlink(scratch_.path() / "other", out());
  EXPECT_FALSE(extract());
  EXPECT_EQ(entries(scratch_.path() / "other"), 0U);
}

TEST_F(RecordedCellTest, ARecordingWithoutAListIsNotComplete) {
  record_by_hand({{"cell.toml", "name = 1"}},
                 {std::string(kGatewayName), {{std::string(kCellFileKey), "/somewhere/cell.toml"}}});
  EXPECT_FALSE(recorded().complete());
  const auto sut = extract();
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(content(sut->cell_file), "name = 1");
}

}  // namespace
}  // namespace cellmirror::app
