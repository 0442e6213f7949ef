// Layout files; what is refused, word by word, stands in tests/golden/config/bad/layout.
#include "config/layout_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

void expect_same(const DisplayLayout& sut, const DisplayLayout& wanted) {
  for (std::size_t id = 0; id < kViews; ++id) {
    EXPECT_EQ(sut.views[id].name, wanted.views[id].name) << id;
    EXPECT_EQ(sut.views[id].towards_viewer, wanted.views[id].towards_viewer) << id;
    EXPECT_EQ(sut.views[id].orthogonal, wanted.views[id].orthogonal) << id;
  }
  for (std::size_t i = 0; i < kDisplays; ++i) {
    EXPECT_EQ(sut.displays[i].name, wanted.displays[i].name) << i + 1;
    ASSERT_EQ(sut.displays[i].panes.size(), wanted.displays[i].panes.size()) << i + 1;
    for (std::size_t k = 0; k < wanted.displays[i].panes.size(); ++k) {
      const LayoutPane& pane = sut.displays[i].panes[k];
      const LayoutPane& other = wanted.displays[i].panes[k];
      EXPECT_EQ(pane.view, other.view);
      EXPECT_EQ(pane.left, other.left);
      EXPECT_EQ(pane.top, other.top);
      EXPECT_EQ(pane.width, other.width);
      EXPECT_EQ(pane.height, other.height);
    }
  }
}

TEST(LayoutFile, TheDocumentedExampleIsTheStandardSetting) {
  Diagnostics diagnostics;
  const auto sut = read_layout(std::filesystem::path(__FILE__).parent_path() / "../../../docs/examples/standard.lay",
                               "standard.lay", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  expect_same(*sut, DisplayLayout{});
}

TEST(LayoutFile, TakesWhatIsGivenAndLeavesTheRestAsInTheStandardSetting) {
  Diagnostics diagnostics;
  const auto sut = parse_layout(R"(format = 1
[[view]]
id = 4
name = "from the gate"
seen_from = [3, 0, 1]
projection = "perspective"
[[display]]
id = 2
name = "gate"
pane = [{ view = 4, area = [0, 0, 0.75, 1] }, { view = 1, area = [0.75, 0, 0.25, 1] }]
[[display]]
id = 6
pane = [{ view = 5 }]
[[display]]
id = 3
name = "plan"
)",
                                "a.lay", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  DisplayLayout wanted;
  wanted.views[4] = {"from the gate", {3, 0, 1}, false};
  wanted.displays[1] = {"gate",
                        {{.view = 4, .left = 0, .top = 0, .width = 0.75, .height = 1},
                         {.view = 1, .left = 0.75, .top = 0, .width = 0.25, .height = 1}}};
  wanted.displays[5].panes = {{.view = 5}};
  wanted.displays[2].name = "plan";
  expect_same(*sut, wanted);
}

TEST(LayoutFile, PanesMayTouchAndLeaveRoomBetweenThem) {
  Diagnostics diagnostics;
  const auto sut = parse_layout(
      "format = 1\n[[display]]\nid = 1\npane = [{ view = 0, area = [0, 0, 0.1, 0.3] }, { view = 1, area = [0.1, 0, "
      "0.2, "
      "0.3] }, { view = 2, area = [0.3, 0, 0.7, 0.3] }, { view = 3, area = [0.5, 0.5, 0.3, 0.3] }]\n",
      "a.lay", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->displays[0].panes.size(), 4U);
}

TEST(LayoutFile, RefusesTextThatIsNoneWithThePlace) {
  for (const std::string text :
       {"format = 1", "", "\x7F\x45LF\x01", "format = 1\n[view]\nid = 0", "format = 1\ndisplay = 3",
        "format = 1\n[[view]]\nid = 0\n[[view", "[[view]]\nid = 0", "format = 1\n[[display]]\nid = 1\npane = []",
        "format = 1\n[[display]]\nid = 1\npane = 3"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse_layout(text, "a.lay", diagnostics)) << text;
    EXPECT_FALSE(diagnostics.ok()) << text;
  }
}

struct CellWithLayout : testing::Test {
  std::optional<LoadedCell> load(const std::string& key) {
    diagnostics = {};
    return load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n[display]\n" + key), diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(CellWithLayout, HasTheStandardSettingWhereNoFileIsNamed) {
  const auto sut = load("");
  ASSERT_TRUE(sut) << diagnostics.text();
  expect_same(sut->layout, DisplayLayout{});
}

TEST_F(CellWithLayout, TakesTheFileBesideItWithAndWithoutItsExtension) {
  home.write("mine.lay", "format = 1\n[[view]]\nid = 0\nname = \"gate\"\n");
  for (const char* key : {"layout_file = \"mine.lay\"\n", "layout_file = \"mine\"\n"}) {
    const auto sut = load(key);
    ASSERT_TRUE(sut) << diagnostics.text();
    EXPECT_EQ(sut->layout.views[0].name, "gate");
  }
}

TEST_F(CellWithLayout, IsRefusedWithAFaultyFileOrOneOutOfItsHome) {
  home.write("bad.lay", "format = 1\n[[view]]\nid = 8\n[[view]]\nid = 9\n");
  EXPECT_FALSE(load("layout_file = \"bad.lay\"\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("bad.lay:3:6: error: view 1: id is 8"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("bad.lay:5:6: error: view 2: id is 9"));
  for (const char* name : {"gone.lay", "../gone.lay", "/etc/passwd", "cell.toml", "", "views.vws"}) {
    EXPECT_FALSE(load("layout_file = \"" + std::string(name) + "\"\n")) << name;
    EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:4:15: error: [display]: ")) << name;
  }
}

}  // namespace
}  // namespace cellmirror
