#include "app/plot/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

// fontconfig keeps its configuration until the process ends; the leak sanitizer asks by this name what is known.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
// NOLINTEND(bugprone-reserved-identifier)

namespace cellmirror::plot {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kSignature = "\x89PNG\r\n\x1a\n";  // PNG specification, 5.2

Figure one_panel() {
  Panel panel{
      .title = "a sine", .x = {"t [s]"}, .y = {"q [rad]"}, .histograms = {}, .lines = {}, .marks = {{2.0, "here"}}};
  Line line{"J_1", {}, {}};
  for (int i = 0; i < 500; ++i) {
    line.x.push_back(0.02 * i);
    line.y.push_back(std::sin(0.02 * i));
  }
  panel.lines.push_back(line);
  Figure figure;
  figure.panels.push_back(panel);
  return figure;
}

// Width and height of the IHDR chunk (PNG specification, 11.2.2).
std::pair<unsigned, unsigned> size_of(const std::string& png) {
  const auto number = [&png](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(png.at(i));
    return value;
  };
  return {number(16), number(20)};
}

class Folder : public testing::Test {
 protected:
  void SetUp() override { fs::create_directory(path_); }
  void TearDown() override { fs::remove_all(path_); }
  fs::path path_ = fs::temp_directory_path() / ("cellmirror-plot-" + std::to_string(getpid()));
};

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Figure, IsAPngOfTheSizeThatItsPanelsTake) {
  Figure sut = one_panel();
  sut.panels.push_back(sut.panels[0]);
  sut.panels.push_back(sut.panels[0]);
  sut.columns = 2;
  sut.panel_width = 400;
  sut.panel_height = 300;
  const auto png = png_of(sut);
  ASSERT_TRUE(png);
  EXPECT_THAT(*png, StartsWith(kSignature));
  EXPECT_EQ(size_of(*png), std::pair(800U, 608U));
}

TEST(Figure, ShowsBarsInRows) {
  Figure sut;
  sut.panels.push_back({.title = "who", .x = {"t [s]"}, .y = {}, .histograms = {}, .lines = {}, .marks = {}});
  sut.panels[0].rows = {"first", "second"};
  const auto empty = png_of(sut);
  sut.panels[0].bars = {{.row = 0, .begin = 0, .end = 2, .label = "a name"}, {.row = 1, .begin = 1, .end = 3}};
  const auto bars = png_of(sut);
  sut.panels[0].bars[0].row = 1;
  const auto other_row = png_of(sut);
  // What has no row, or no time, is left out.
  sut.panels[0].bars = {{.row = 2, .begin = 0, .end = 2}, {.row = 0, .begin = NAN, .end = 2}};
  const auto strange = png_of(sut);
  ASSERT_TRUE(empty && bars && other_row && strange);
  EXPECT_NE(*empty, *bars);
  EXPECT_NE(*bars, *other_row);
}

TEST(Figure, ShowsTheDataAndTheWords) {
  Figure sut = one_panel();
  const auto with_all = png_of(sut);
  sut.panels[0].lines[0].y.assign(500, 0.5);
  const auto flat = png_of(sut);
  sut.panels[0].title = "another title";
  const auto renamed = png_of(sut);
  ASSERT_TRUE(with_all && flat && renamed);
  EXPECT_NE(*with_all, *flat);
  EXPECT_NE(*flat, *renamed);
}

TEST(Figure, IsTheSameForTheSameData) { EXPECT_EQ(png_of(one_panel()).value(), png_of(one_panel()).value()); }

TEST(Figure, CopesWithNoDataGapsAndLinesOfUnequalLength) {
  Figure sut = one_panel();
  sut.panels[0].lines = {
      {"gap", {0, 1, std::nan(""), 3}, {0, INFINITY, 1, 2}}, {"short", {1, 2, 3}, {1}}, {"", {}, {}}};
  sut.panels[0].histograms = {{{}, 0}, {{1, 2, 3}, 1'000'000'000}};
  EXPECT_TRUE(png_of(sut));
  sut.panels[0] = Panel{};
  EXPECT_TRUE(png_of(sut));
}

TEST(Figure, DrawsWordsOfAnyBytes) {
  Figure sut = one_panel();
  for (const char* words :
       {"\xff", "a\x80z", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x01\n\x7f", "größe µs 10⁻⁶"}) {
    sut.title = words;
    sut.panels[0].x.label = words;
    EXPECT_TRUE(png_of(sut)) << words;
  }
}

TEST(Figure, DrawsAMillionPointsWithoutAMillionStrokes) {
  Figure sut = one_panel();
  Line& line = sut.panels[0].lines[0];
  line.x.resize(1'000'000);
  line.y.resize(line.x.size());
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    line.x[i] = static_cast<double>(i);
    line.y[i] = std::sin(static_cast<double>(i));
  }
  EXPECT_TRUE(png_of(sut));
}

TEST(Figure, IsRefusedWithoutPanelsAndBeyondTheSizeOfAPicture) {
  EXPECT_FALSE(png_of(Figure{}));
  Figure sut = one_panel();
  sut.panel_height = 2'000'000'000;
  EXPECT_FALSE(png_of(sut));
  sut.panel_height = 3;
  EXPECT_FALSE(png_of(sut));
}

TEST_F(Folder, TakesAFileAndReplacesIt) {
  const fs::path file = path_ / "a.png";
  std::ofstream(file) << "old";
  ASSERT_TRUE(write_png(one_panel(), file.string()));
  EXPECT_THAT(content(file), StartsWith(kSignature));
  EXPECT_EQ(std::distance(fs::directory_iterator(path_), {}), 1);
}

TEST_F(Folder, ThatDoesNotExistIsToldWithTheReason) {
  const auto written = write_png(one_panel(), (path_ / "nowhere" / "a.png").string());
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().text(), HasSubstr("nowhere"));
  EXPECT_THAT(written.error().text(), HasSubstr("No such file"));
  EXPECT_FALSE(write_png(one_panel(), path_.string()));
}

}  // namespace
}  // namespace cellmirror::plot
