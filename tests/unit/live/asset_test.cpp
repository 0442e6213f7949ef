// Which files of a cell a client may have.
#include "app/live/asset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class AssetTest : public testing::Test {
 protected:
  AssetTest() {
    std::string pattern = (fs::temp_directory_path() / "asset.XXXXXX").string();
    root_ = ::mkdtemp(pattern.data());
    fs::create_directories(root_ / "cell" / "envlib" / "my meshes");
    write(root_ / "cell" / "envlib" / "my meshes" / "a b.STL", "mesh");
    write(root_ / "cell" / "cell.toml", "name = \"c\"");
    write(root_ / "outside.stl", "secret");
    fs::create_symlink(root_ / "outside.stl", root_ / "cell" / "link.stl");
    fs::create_symlink("cell.toml", root_ / "cell" / "picture.png");
  }
  ~AssetTest() override { fs::remove_all(root_); }

  static void write(const fs::path& file, std::string_view text) { std::ofstream(file) << text; }
  [[nodiscard]] KismetHome home() const { return *KismetHome::open(root_ / "cell"); }
  [[nodiscard]] std::string why(std::string_view uri, std::size_t most_bytes = 100) const {
    const auto content = read_asset(home(), uri, most_bytes);
    return content ? std::string() : content.error().text();
  }

  fs::path root_;
};

TEST_F(AssetTest, AMeshIsFoundByItsUri) {
  const std::string file = (home().root() / "envlib" / "my meshes" / "a b.STL").string();
  const std::string uri = asset_uri(home(), file);
  EXPECT_EQ(uri, "package://cell/envlib/my%20meshes/a%20b.STL");
  const auto content = read_asset(home(), uri, 100);
  ASSERT_TRUE(content) << content.error().text();
  EXPECT_EQ(*content, "mesh");
  EXPECT_EQ(asset_uri(home(), (root_ / "outside.stl").string()), "") << "not in the cell folder";
}

TEST_F(AssetTest, OtherFilesAreRefused) {
  for (const char* uri :
       {"package://cell/../outside.stl", "package://cell/%2E%2E/outside.stl", "package://cell/link.stl",
        "package://cell/envlib/../../outside.stl", "package://cell//etc/passwd", "package://cell/none.stl",
        "package://cell/envlib", "package://cell/", "package://cell/%zz.stl", "package://cell/a%00.stl",
        "package://other/a.stl", "file:///etc/passwd", "envlib/a.stl", ""})
    EXPECT_NE(why(uri), "") << uri;
  EXPECT_THAT(why("package://cell/cell.toml"), HasSubstr("no mesh"));
  EXPECT_THAT(why("package://cell/picture.png"), HasSubstr("no mesh")) << "the link's own name does not count";
}

TEST_F(AssetTest, ALargeFileIsRefusedUnread) {
  EXPECT_THAT(why("package://cell/envlib/my%20meshes/a%20b.STL", 3), HasSubstr("more than the limit"));
}

}  // namespace
}  // namespace cellmirror::app
