#include <gtest/gtest.h>

#include <numbers>

#include "config/volume/nrrd_file.hpp"
#include "config/volume/nrrd_head.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/volume_files/volume_text.hpp"

namespace cellmirror {
namespace {

std::string why_no_nrrd(const std::string& head) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_nrrd_head(head, "a.nrrd", diagnostics)) << head;
  return diagnostics.text();
}

TEST(NrrdHead, SaysSizeTypeAndSpacingInMillimetres) {
  const std::string head = nrrd_head() + "\n";
  Diagnostics diagnostics;
  const auto sut = parse_nrrd_head(head + "DATA", "a.nrrd", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->format.size, (std::array<std::uint32_t, 3>{4, 3, 2}));
  EXPECT_EQ(sut->format.type, VoxelType::s16);
  EXPECT_TRUE(sut->spacing_m.isApprox(Eigen::Vector3d(0.0005, 0.0007, 0.0015)));
  EXPECT_EQ(sut->data_offset, head.size());
  EXPECT_FALSE(sut->X_PV);
}

TEST(NrrdHead, TakesUnitsOfLengthAndLinesWithCarriageReturns) {
  Diagnostics diagnostics;
  const auto sut = parse_nrrd_head(
      "NRRD0005\r\n# c\r\ntype: uint8\r\ndimension: 3\r\nsizes: 4 3 2\r\nencoding: gz\r\nkey:=value\r\n"
      "spacings: 1 2 3\r\nunits: \"cm\" \"cm\" \"cm\"\r\n\r\n",
      "a.nrrd", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(sut->gzip);
  EXPECT_TRUE(sut->spacing_m.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)));
}

TEST(NrrdHead, PlacesTheMiddleByOriginAndDirections) {
  Diagnostics diagnostics;
  const auto sut = parse_nrrd_head(
      nrrd_head(
          "space: left-posterior-superior\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (10,20,30)\n") +
          "\n",
      "a.nrrd", diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_FALSE(sut->format.last_slice_first);
  EXPECT_TRUE(sut->spacing_m.isApprox(Eigen::Vector3d(0.002, 0.003, 0.004)));
  ASSERT_TRUE(sut->X_PV);
  // 1.5 steps of 2 mm along y, 1 of 3 mm along -x, 0.5 of 4 mm along z.
  EXPECT_TRUE(sut->X_PV->translation().isApprox(Eigen::Vector3d(0.007, 0.023, 0.032), 1e-12));
  EXPECT_TRUE(sut->X_PV->linear().col(0).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(sut->X_PV->linear().determinant(), 1, 1e-12);
}

TEST(NrrdHead, TurnsLeftHandedAxesRoundByTheOrderOfTheSlices) {
  Diagnostics diagnostics;
  const auto sut = parse_nrrd_head(
      nrrd_head("space: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,-2)\nspace origin: (0,0,0)\n") + "\n", "a.nrrd",
      diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(sut->format.last_slice_first);
  EXPECT_NEAR(sut->X_PV->linear().determinant(), 1, 1e-12);
  // RAS (1.5, 1, -1) mm in LPS.
  EXPECT_TRUE(sut->X_PV->translation().isApprox(Eigen::Vector3d(-0.0015, -0.001, -0.001), 1e-12));
}

TEST(NrrdHead, IsRefusedByNameAndLine) {
  EXPECT_NE(why_no_nrrd("NRRD0009\n").find("a.nrrd:1"), std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("", "block") + "\n").find("a.nrrd:2: error: the type block"), std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("", "short", "bzip2") + "\n").find("the encoding bzip2"), std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("spacings: 1 nan 1\n") + "\n").find("the spacing nan is no number"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("spacings: 1 1 0\n") + "\n").find("is not between"), std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("space directions: (1,0,0) (0.3,1,0) (0,0,1)\n") + "\n").find("right angles"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("kinds: 3-vector domain domain\n") + "\n").find("of kind 3-vector"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd("NRRD0004\ntype: short\ndimension: 4\nsizes: 4 3 2 2\nendian: little\nencoding: raw\n\n")
                .find("the dimension is 4"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd("NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 1\nendian: little\nencoding: raw\n\n")
                .find("at least 2 voxels"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd("NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n\n").find("endian"),
            std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head()).find("neither an empty line"), std::string::npos);
  EXPECT_NE(why_no_nrrd(nrrd_head("sizes: 4 3 2\n") + "\n").find("another \"sizes\""), std::string::npos);
}

TEST(NrrdHead, NamesItsDataFilesOneByOneOrByAPattern) {
  Diagnostics diagnostics;
  const auto pattern =
      parse_nrrd_head(nrrd_head("spacings: 1 1 1\ndata file: s%02d.raw 1 2 1\n"), "a.nhdr", diagnostics);
  ASSERT_TRUE(pattern) << diagnostics.text();
  EXPECT_EQ(pattern->data_files, (std::vector<std::string>{"s01.raw", "s02.raw"}));
  const auto list =
      parse_nrrd_head(nrrd_head("spacings: 1 1 1\ndata file: LIST\nb.raw\na.raw\n"), "a.nhdr", diagnostics);
  ASSERT_TRUE(list) << diagnostics.text();
  EXPECT_EQ(list->data_files, (std::vector<std::string>{"b.raw", "a.raw"}));
  EXPECT_NE(why_no_nrrd(nrrd_head("data file: s%d.raw 1 5 1\n")).find("do not hold 2 slices"), std::string::npos);
}

class NrrdFile : public testing::Test {
 protected:
  std::optional<VolumeData> read(const std::string& name, const std::string& text) {
    return read_nrrd(home_.write("envlib/" + name, text), diagnostics_);
  }
  TemporaryHome home_;
  Diagnostics diagnostics_;
};

TEST_F(NrrdFile, HasTheSameValuesRawAndCompressedAttachedAndDetached) {
  const auto values = counting<std::int16_t>(24, -5);
  const std::string data = bytes_of(values);
  const auto attached = read("a.nrrd", nrrd_head() + "\n" + data);
  const auto compressed = read("b.nrrd", nrrd_head("spacings: 1 1 1\n", "short", "gzip") + "\n" + gzip(data));
  home_.write("envlib/c.raw", "xx\n" + data);
  const auto detached = read("c.nhdr", nrrd_head("spacings: 1 1 1\nline skip: 1\ndata file: c.raw\n"));
  const auto at_end = read("d.nhdr", nrrd_head("spacings: 1 1 1\nbyte skip: -1\ndata file: c.raw\n"));
  home_.write("envlib/s1.raw", data.substr(0, 24));
  home_.write("envlib/s2.raw", data.substr(24));
  const auto slices = read("e.nhdr", nrrd_head("spacings: 1 1 1\ndata file: s%d.raw 1 2 1\n"));
  for (const auto* sut : {&attached, &compressed, &detached, &at_end, &slices}) {
    ASSERT_TRUE(*sut) << diagnostics_.text();
    EXPECT_EQ(std::get<std::vector<std::int16_t>>((*sut)->grid.values), values);
    EXPECT_EQ((*sut)->grid.slope, 1);
  }
  EXPECT_EQ(slices->facts.files.size(), 2U);
}

TEST_F(NrrdFile, ReversesTheSlicesOfLeftHandedAxes) {
  const auto values = counting<std::int16_t>(24);
  const auto sut =
      read("a.nrrd", nrrd_head("space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,-1)\n") + "\n" + bytes_of(values));
  ASSERT_TRUE(sut) << diagnostics_.text();
  const auto& read_values = std::get<std::vector<std::int16_t>>(sut->grid.values);
  EXPECT_EQ(read_values.front(), 12);
  EXPECT_EQ(read_values[12], 0);
}

TEST_F(NrrdFile, IsRefusedWithTooFewDataOrNaN) {
  EXPECT_FALSE(read("a.nrrd", nrrd_head() + "\n" + std::string(47, 'x')));
  EXPECT_NE(diagnostics_.text().find("has 146 bytes, 147 are needed"), std::string::npos) << diagnostics_.text();
  std::vector<float> values(24, 1.0F);
  values[17] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(read("b.nrrd", nrrd_head("spacings: 1 1 1\n", "float") + "\n" + bytes_of(values)));
  EXPECT_NE(diagnostics_.text().find("the voxel (1, 1, 1) is nan"), std::string::npos) << diagnostics_.text();
}

TEST_F(NrrdFile, DoesNotLeaveItsFolder) {
  home_.write("secret.raw", std::string(48, 'x'));
  EXPECT_FALSE(read("a.nhdr", nrrd_head("spacings: 1 1 1\ndata file: ../secret.raw\n")));
  EXPECT_NE(diagnostics_.text().find("leaves"), std::string::npos) << diagnostics_.text();
  std::filesystem::create_symlink("../secret.raw", home_.root() / "envlib/link.raw");
  Diagnostics again;
  EXPECT_FALSE(read_nrrd(home_.write("envlib/b.nhdr", nrrd_head("spacings: 1 1 1\ndata file: link.raw\n")), again));
  EXPECT_NE(again.text().find("leaves"), std::string::npos) << again.text();
}

TEST_F(NrrdFile, TakesNoMemoryForWhatItsCompressedDataCannotHold) {
  std::string head = nrrd_head("spacings: 1 1 1\n", "short", "gzip");
  head.replace(head.find("4 3 2"), 5, "1000 1000 1000");
  EXPECT_FALSE(read("a.nrrd", head + "\n" + gzip("little")));
  EXPECT_NE(diagnostics_.text().find("cannot hold 2000000000 bytes"), std::string::npos) << diagnostics_.text();
}

}  // namespace
}  // namespace cellmirror
