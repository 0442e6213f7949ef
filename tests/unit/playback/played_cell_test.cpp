// Attached files go below the folder of the cell and nowhere else.
#include "app/playback/played_cell.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/recording/recording_names.hpp"
#include "ipc/record/byte_stream.hpp"
#include "ipc/record/writer.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

TEST(PlaceOfAnAttachment, StaysBelowTheFolder) {
  for (const char* name : {"cell.toml", "envlib/a.mpc", "a b/\xC3\xA4.mpc", ".hidden", "a..b"})
    EXPECT_TRUE(is_place_below(name)) << name;
  for (const std::string& name : {""s, "/etc/passwd"s, "../a"s, "a/../../b"s, "a/.."s, "."s, "./a"s, "a/"s, "a\nb"s,
                                  "a\0b"s, "..\\a"s, std::string(2000, 'a')})
    EXPECT_FALSE(is_place_below(name)) << name;
}

TEST(PrivateFolderTest, IsOfTheUserAloneAndGoesWithItsContent) {
  fs::path path;
  {
    auto folder = PrivateFolder::make();
    ASSERT_TRUE(folder) << folder.error().text();
    path = folder->path();
    struct stat about{};
    ASSERT_EQ(::stat(path.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777U, 0700U);
    std::ofstream(path / "file") << "x";
  }
  EXPECT_FALSE(fs::exists(path));
}

class WriteCell : public testing::Test {
 protected:
  Result<fs::path> write(const std::vector<std::pair<std::string, std::string>>& files) {
    const fs::path recording = scratch_->path() / "a.mcap";
    {
      auto sink = mcap::FileSink::create(recording);
      EXPECT_TRUE(sink);
      mcap::Writer writer(**sink, {});
      EXPECT_TRUE(writer.begin());
      for (const auto& [name, content] : files) {
        mcap::Attachment attachment;
        attachment.name = name;
        attachment.data = mcap::view_of(content);
        EXPECT_TRUE(writer.put(attachment));
      }
      EXPECT_TRUE(writer.put(mcap::Metadata{.name = std::string(kGatewayName),
                                            .values = {{std::string(kCellFileKey), "/srv/cells/cell.toml"}}}));
      EXPECT_TRUE(writer.finish());
    }
    const auto source = mcap::FileSource::open(recording);
    const auto reader = mcap::Reader::open(**source);
    EXPECT_TRUE(reader);
    fs::create_directory(folder_);
    return write_cell(*reader, folder_);
  }

  Result<PrivateFolder> scratch_ = PrivateFolder::make();
  fs::path folder_ = scratch_->path() / "cell";
};

TEST_F(WriteCell, GivesTheCellFile) {
  const auto cell = write({{"cell.toml", "name = 1"}, {"envlib/a.mpc", "solid"}});
  ASSERT_TRUE(cell) << cell.error().text();
  EXPECT_EQ(*cell, folder_ / "cell.toml");
  std::ostringstream text;
  text << std::ifstream(folder_ / "envlib" / "a.mpc").rdbuf();
  EXPECT_EQ(text.str(), "solid");
}

TEST_F(WriteCell, RefusesANameThatLeavesTheFolder) {
  const auto cell = write({{"cell.toml", ""}, {"../outside", "x"}});
  ASSERT_FALSE(cell);
  EXPECT_TRUE(cell.error().what.contains("../outside")) << cell.error().what;
  EXPECT_FALSE(fs::exists(scratch_->path() / "outside"));
}

TEST_F(WriteCell, WithoutTheCellFileThereIsNone) { EXPECT_FALSE(write({{"other.toml", ""}})); }

}  // namespace
}  // namespace cellmirror::app
