#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

#include "config/volume_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/volume_files/volume_text.hpp"

namespace cellmirror {
namespace {

const char* const kSlices =
    "format = 1\npattern = \"s.%d\"\nfirst = 1\nlast = 2\nsize = [4, 3, 2]\nspacing_mm = [1, 2, 3]\n"
    "type = \"u16\"\nendian = \"big\"\nheader_bytes = 3\nslope = 2\nintercept = -10\nhounsfield = true\n";

std::string why_no_raw_head(const std::string& head) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_raw_volume_head(head, "a.toml", diagnostics)) << head;
  return diagnostics.text();
}

TEST(RawVolume, IsReadSliceBySliceAsItsHeadSays) {
  const TemporaryHome home;
  const auto values = counting<std::uint16_t>(24, 65000);
  const std::string data = bytes_of(values, true);
  home.write("envlib/s.1", "abc" + data.substr(0, 24));
  home.write("envlib/s.2", "abc" + data.substr(24));
  Diagnostics diagnostics;
  const auto sut = read_volume(home.write("envlib/a.toml", kSlices), {"a.toml", {}, {}, "a"}, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(sut->grid.values), values);
  EXPECT_EQ(sut->grid.slope, 2);
  EXPECT_EQ(sut->grid.intercept, -10);
  EXPECT_TRUE(sut->grid.hounsfield);
  EXPECT_TRUE(sut->grid.spacing_m.isApprox(Eigen::Vector3d(0.001, 0.002, 0.003)));
  EXPECT_EQ(sut->grid.name, "a");
}

TEST(RawVolume, IsRefusedByNameWhereItsHeadDoesNotFit) {
  const std::string good = kSlices;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return why_no_raw_head(text);
  };
  EXPECT_NE(with("last = 2", "last = 3").find("there are 3 files for 2 slices"), std::string::npos);
  EXPECT_NE(with("size = [4, 3, 2]", "size = [4, 3, 2.5]").find("not three integers"), std::string::npos);
  EXPECT_NE(with("type = \"u16\"", "type = \"f32\"").find("f32"), std::string::npos);
  EXPECT_NE(with("endian = \"big\"\n", "").find("endian"), std::string::npos);
  EXPECT_NE(with("slope = 2", "slope = 0").find("the slope is 0"), std::string::npos);
  EXPECT_NE(with("slope = 2", "file = \"b\"").find("one file, or a file a slice"), std::string::npos);
  EXPECT_NE(with("slope = 2", "encoding = \"gzip\"").find("several compressed files"), std::string::npos);
  EXPECT_NE(with("slope = 2", "slop = 2").find("did you mean slope"), std::string::npos);
}

TEST(RawVolume, IsRefusedWhereAFileIsShort) {
  const TemporaryHome home;
  home.write("envlib/s.1", std::string(27, 'x'));
  home.write("envlib/s.2", std::string(26, 'x'));
  Diagnostics diagnostics;
  EXPECT_FALSE(read_volume(home.write("envlib/a.toml", kSlices), {"a.toml", {}, {}, "a"}, diagnostics));
  EXPECT_NE(diagnostics.text().find("s.2 has 26 bytes, 27 are needed"), std::string::npos) << diagnostics.text();
}

TEST(RawVolume, MayBeAScanInNumberedFiles) {
  const char* set = std::getenv("CELLMIRROR_SHARED_DATA");
  const std::filesystem::path shared =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(std::getenv("CELLMIRROR_SOURCE_DIR")).parent_path() / "shared/data";
  if (!std::filesystem::exists(shared / "ct/headsq/quarter.93"))
    GTEST_SKIP() << "skipped: shared/data/ct/headsq does not exist";
  const TemporaryHome home;
  for (int i = 1; i <= 93; ++i) {
    const std::string name = "quarter." + std::to_string(i);
    std::filesystem::copy_file(shared / "ct/headsq" / name, home.root() / "envlib" / name);
  }
  Diagnostics diagnostics;
  const auto sut =
      read_volume(home.write("envlib/head.toml",
                             "format = 1\npattern = \"quarter.%d\"\nfirst = 1\nlast = 93\nsize = [64, 64, 93]\n"
                             "spacing_mm = [3.2, 3.2, 1.5]\ntype = \"u16\"\nendian = \"little\"\n"),
                  {"head.toml", {}, {}, "head"}, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  // Air around a head: the corners are nearly zero, bone is above 1150 (as users of this scan know it).
  const auto& values = std::get<std::vector<std::uint16_t>>(sut->grid.values);
  EXPECT_LT(values.front(), 100);
  EXPECT_LT(values.back(), 100);
  const auto most = *std::ranges::max_element(values);
  EXPECT_GT(most, 1150);
  EXPECT_LT(most, 5000);
}

}  // namespace
}  // namespace cellmirror
