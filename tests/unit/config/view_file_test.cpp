#include "config/view_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace cellmirror {
namespace {

std::optional<ViewFile> parse(std::string_view text, Diagnostics& diagnostics) {
  return parse_views(text, "a.vws", diagnostics);
}

TEST(ViewFile, ReadsWhatIsGivenAndLeavesTheRestOpen) {
  Diagnostics diagnostics;
  const auto sut = parse(R"(format = 1
[display]
layout = 2
full_screen = true
[[view]]
id = 6
viewpoint_m = [1, 2.5, -3]
opening_angle_rad = 0.5
projection = "parallel"
camera = "UMG_Kamera_1"
[[view]]
id = 0
twist_rad = -0.25
)",
                         diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  ASSERT_TRUE(sut->display);
  EXPECT_EQ(sut->display->display, 2);
  EXPECT_TRUE(sut->display->full_screen);
  ASSERT_EQ(sut->views.size(), 2U);
  EXPECT_EQ(sut->views[0].id, 6);
  EXPECT_EQ(*sut->views[0].change.viewpoint, Eigen::Vector3d(1, 2.5, -3));
  EXPECT_EQ(*sut->views[0].change.opening_angle, 0.5);
  EXPECT_FALSE(sut->views[0].change.lookpoint);
  EXPECT_EQ(sut->views[0].orthogonal, true);
  EXPECT_EQ(sut->views[0].camera, "UMG_Kamera_1");
  EXPECT_EQ(*sut->views[1].change.twist, -0.25);
  EXPECT_FALSE(sut->views[1].orthogonal);
  EXPECT_EQ(sut->views[1].camera, "");
}

TEST(ViewFile, FindsEverythingThatIsWrongInOnePass) {
  Diagnostics diagnostics;
  const auto sut = parse(R"(format = 2
[display]
layout = 7
colour = "red"
[[view]]
id = 7
[[view]]
id = 3
viewpoint_m = [1, 2]
opening_angle_rad = 3.2
[[view]]
id = 3
viewpoint_m = [0, 0, 1]
lookpoint_m = [0, 0, 1]
near_m = 2
far_m = 1
projection = "fisheye"
twist_deg = 90
camera = ""
[[view]]
viewpoint_m = [0, 0, 20000]
twist_rad = nan
)",
                         diagnostics);
  EXPECT_FALSE(sut);
  EXPECT_EQ(diagnostics.text(), R"(a.vws:1:10: error: format 2 is unknown; this version reads format = 1
a.vws:3:10: error: [display]: layout is 7, but must be between 1 and 6
a.vws:4:1: error: [display]: the key colour is unknown; the keys here are full_screen, layout
a.vws:6:6: error: view 1: id is 7, but must be between 0 and 6
a.vws:9:15: error: view 2: viewpoint_m must be an array of 3 numbers, but is an array of 2
a.vws:10:21: error: view 2: opening_angle_rad is 3.2, but must be above 0 and below 3.14159
a.vws:12:6: error: view 3: view 3 appears twice
a.vws:13:15: error: view 3: the viewpoint is the lookpoint; choose two different points
a.vws:15:10: error: view 3: the near plane is not nearer than the far plane
a.vws:17:14: error: view 3: projection cannot be "fisheye"; it is one of perspective, parallel
a.vws:18:1: error: view 3: the key twist_deg is unknown; files are in SI: write twist_rad = 1.57079633
a.vws:19:10: error: view 3: the camera's name is empty; omit the key for a view without a camera
a.vws:20:1: error: view 4: the key id is missing
a.vws:21:15: error: view 4: viewpoint_m is 20000, but must be at least -10000 and at most 10000
a.vws:22:13: error: view 4: twist_rad is not a finite number
)");
}

TEST(ViewFile, RefusesTextThatIsNoneWithThePlace) {
  for (const std::string text : {"format = 1", "", "\x7F\x45LF\x01", "format = 1\n[view]\nid = 0",
                                 "format = 1\nview = 3", "format = 1\n[[view]]\nid = 0\n[[view", "id = 0"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse(text, diagnostics)) << text;
    EXPECT_FALSE(diagnostics.ok()) << text;
  }
}

// The parser reads quotes within a number as part of it, and holds some characters for impossible there.
TEST(ViewFile, TakesOtherCharactersThanAsciiInTextsOnly) {
  for (const std::string text :
       {"format = 10!x='\xEF\xB3\xBF'", "format = 1\ntwist=33[\"\xC4\xA4\"]", "format = 3.\"\xC4\xA4\""}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse(text, diagnostics)) << text;
    EXPECT_NE(diagnostics.text().find("outside ASCII"), std::string::npos) << diagnostics.text();
  }
  Diagnostics diagnostics;
  const auto sut = parse("format = 1\nview=[{id=0,camera='\xC3\x9C'},{id=1,camera = \"\xC3\x9C\"}]", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->views[0].camera, "\xC3\x9C");
}

TEST(ViewFile, WritesWhatItReadsAgainExactly) {
  DisplayState display;
  display.display = 5;
  display.full_screen = true;
  display.views[2].view.viewpoint = {0.1, -1.0 / 3.0, 1e-7};
  display.views[2].view.twist = -3.0;
  display.views[2].view.far_distance = 12345.678901234567;
  display.views[2].view.orthogonal = true;
  display.views[2].camera = "Lab.CAMERA\\5";
  Diagnostics diagnostics;
  const auto sut = parse(views_text(display), diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text() << views_text(display);
  ASSERT_EQ(sut->views.size(), kViews);
  EXPECT_EQ(sut->display->display, 5);
  EXPECT_TRUE(sut->display->full_screen);
  for (std::size_t id = 0; id < kViews; ++id) {
    const StoredView& row = sut->views[id];
    const View& view = display.views[id].view;
    EXPECT_EQ(row.id, static_cast<int>(id));
    EXPECT_EQ(*row.change.viewpoint, view.viewpoint);
    EXPECT_EQ(*row.change.lookpoint, view.lookpoint);
    EXPECT_EQ(*row.change.twist, view.twist);
    EXPECT_EQ(*row.change.opening_angle, view.opening_angle);
    EXPECT_EQ(*row.change.near_distance, view.near_distance);
    EXPECT_EQ(*row.change.far_distance, view.far_distance);
    EXPECT_EQ(*row.orthogonal, view.orthogonal);
    EXPECT_EQ(row.camera, display.views[id].camera);
  }
}

TEST(ViewFile, RefusesFilesThatAreTooLargeOrNoFiles) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("cellmirror_views_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "large.vws") << std::string(kLargestViewFile + 1, '#');
  for (const char* name : {"large.vws", "missing.vws", "."}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_views(folder / name, name, diagnostics)) << name;
    EXPECT_EQ(diagnostics.errors(), 1U) << name;
  }
  EXPECT_TRUE(write_views(folder / "new.vws", DisplayState{}));
  EXPECT_FALSE(write_views(folder / "missing" / "new.vws", DisplayState{}));
  Diagnostics diagnostics;
  EXPECT_TRUE(read_views(folder / "new.vws", "new.vws", diagnostics)) << diagnostics.text();
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cellmirror
