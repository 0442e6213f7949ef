#include "config/wall_file.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror {
namespace {

std::optional<WallSettings> parsed_wall(const std::string& text, Diagnostics& diagnostics) {
  return parse_wall(text, "wall.toml", AnyFile(), diagnostics);
}

std::string wall_errors(const std::string& text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parsed_wall(text, diagnostics)) << text;
  return diagnostics.text();
}

TEST(WallFile, NamesCellsAndWhereTheWallListens) {
  Diagnostics diagnostics;
  const auto wall = parsed_wall(R"(format = 1
[wall]
port = 9000
domain = 7
interface_address = "10.0.0.5"
silent_after_s = 5
[dds]
discovery_servers = ["10.0.0.1:11811"]
[[cell]]
name = "press_line"
title = "Press line 1"
host = "press-pc"
instance = "press"
page = "http://127.0.0.1:9001/"
thumbnail = "/press/picture/compressed"
partition = "press"
[[cell]]
name = "paint"
)",
                                diagnostics);
  ASSERT_TRUE(wall) << diagnostics.text();
  EXPECT_EQ(wall->port, 9000);
  EXPECT_EQ(wall->address, "127.0.0.1");
  EXPECT_EQ(wall->domain, 7);
  EXPECT_EQ(wall->interface_address, "10.0.0.5");
  EXPECT_EQ(wall->silent_after, Nanoseconds(5'000'000'000));
  ASSERT_EQ(wall->network.discovery_servers.size(), 1u);
  ASSERT_EQ(wall->cells.size(), 2u);
  EXPECT_EQ(wall->cells[0], (WallCell{"press_line", "Press line 1", "press-pc", "press", "http://127.0.0.1:9001/",
                                      "rt/press/picture/compressed", "press"}));
  EXPECT_EQ(wall->cells[1].name, "paint");
}

TEST(WallFile, IsGoodWithNothingButItsFormat) {
  Diagnostics diagnostics;
  const auto wall = parsed_wall("format = 1\n", diagnostics);
  ASSERT_TRUE(wall) << diagnostics.text();
  EXPECT_TRUE(wall->cells.empty());
}

TEST(WallFile, SaysWhatIsWrongAndWhere) {
  const std::string text = wall_errors(R"(format = 1
[wall]
address = "0.0.0.0"
interface_address = "host"
colour = "red"
[[cell]]
title = "nameless"
[[cell]]
name = "A"
[[cell]]
name = "A"
)");
  EXPECT_NE(text.find("wall.toml:3:11: error: [wall]: the page at 0.0.0.0 would be reachable from other machines"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("wall.toml:4:"), std::string::npos) << text;
  EXPECT_NE(text.find("wall.toml:5:"), std::string::npos) << text;
  EXPECT_NE(text.find("wall.toml:6:"), std::string::npos) << text;
  EXPECT_NE(text.find("wall.toml:11:8: error: cell A: the name appears twice"), std::string::npos) << text;
}

TEST(WallFile, TakesNoPageThatCarriesASecretOrAScript) {
  for (const char* page : {"http://127.0.0.1:9001/#token=0123", "http://user:secret@host/", "javascript:alert(1)",
                           "http://host/?token=1", "http://", "ftp://host/", "http:///x", "http://host/\\\"x"}) {
    const std::string text = wall_errors("format = 1\n[[cell]]\nname = \"A\"\npage = \"" + std::string(page) + "\"\n");
    EXPECT_NE(text.find("page"), std::string::npos) << page << text;
  }
}

TEST(WallFile, BoundsCellsAndPictures) {
  std::string cells = "format = 1\n";
  for (std::size_t i = 0; i <= kMostWallThumbnails; ++i)
    cells += "[[cell]]\nname = \"c" + std::to_string(i) + "\"\nthumbnail = \"/a\"\n";
  EXPECT_NE(wall_errors(cells).find("65 cells have a thumbnail, but at most 64 may"), std::string::npos);
  std::string many = "format = 1\n";
  for (std::size_t i = 0; i <= kMostWallCells; ++i) many += "[[cell]]\nname = \"c" + std::to_string(i) + "\"\n";
  static_cast<void>(wall_errors(many));
  static_cast<void>(wall_errors("format = 1\n[[cell]]\nname = \"" + std::string(200, 'x') + "\"\n"));
  static_cast<void>(wall_errors("format = 1\n[[cell]]\nname = \"\"\n"));
}

}  // namespace
}  // namespace cellmirror
