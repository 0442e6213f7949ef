// Pictures on meshes: what is decoded, and that no file makes them cost more than they may.
#include "config/picture_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/picture_library.hpp"
#include "tests/unit/config/picture_bytes.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<int> rgba_at(const Image& image, int x, int y) {
  const std::uint8_t* const p = image.pixel(x, y);
  return {p[0], p[1], p[2], p[3]};
}

TEST(PictureFile, reads_png_and_jpeg) {
  std::size_t room = kMostPictureBytes;
  const auto png = decode_picture(four_pixels(), room);
  ASSERT_TRUE(png) << png.error().text();
  EXPECT_EQ(png->width, 2);
  EXPECT_EQ(png->height, 2);
  EXPECT_THAT(rgba_at(*png, 0, 0), ElementsAre(255, 0, 0, 255));
  EXPECT_THAT(rgba_at(*png, 1, 0), ElementsAre(0, 255, 0, 255));
  EXPECT_THAT(rgba_at(*png, 0, 1), ElementsAre(0, 0, 255, 255));
  EXPECT_THAT(rgba_at(*png, 1, 1), ElementsAre(255, 255, 255, 128));
  const auto jpeg = decode_picture(red_jpeg(), room);
  ASSERT_TRUE(jpeg) << jpeg.error().text();
  EXPECT_EQ(jpeg->rgba.size(), 256U);
  EXPECT_GT(jpeg->pixel(4, 4)[0], 245);
  EXPECT_LT(jpeg->pixel(4, 4)[1], 10);
  EXPECT_EQ(jpeg->pixel(4, 4)[3], 255);
}

TEST(PictureFile, refuses_what_is_damaged_too_large_or_of_another_kind) {
  const auto refusal = [](const std::string& bytes) {
    std::size_t room = kMostPictureBytes;
    const auto sut = decode_picture(bytes, room);
    return sut ? "accepted" : sut.error().what;
  };
  EXPECT_EQ(refusal(""), "it is empty");
  EXPECT_EQ(refusal("GIF89a"), "it is neither PNG nor JPEG");
  EXPECT_EQ(refusal(png_of(4097, 1, std::string(std::size_t{4} * 4097, 'x'))),
            "it has 4097 x 1 pixels, more than 4096 x 4096");
  EXPECT_THAT(refusal(png_of(0x7FFF'FFFF, 0x7FFF'FFFF, "")), testing::AnyOf(HasSubstr("it has"), HasSubstr("damaged")));
  const std::string png = four_pixels();
  const std::string jpeg = red_jpeg();
  for (std::size_t length = 8; length < png.size() - 12; ++length)  // without IEND it is whole enough
    EXPECT_THAT(refusal(png.substr(0, length)), HasSubstr("it is damaged: ")) << length;
  for (std::size_t length = 3; length + 2 < jpeg.size(); length += 5)
    EXPECT_NE(refusal(jpeg.substr(0, length)), "accepted") << length;
  std::string flipped = png;
  flipped[45] = static_cast<char>(flipped[45] ^ 1);
  EXPECT_THAT(refusal(flipped), HasSubstr("it is damaged: "));
}

// Ends behind its header.
std::string damaged_png(std::uint32_t edge) { return png_of(edge, edge, ""); }

std::string refusal(const Result<Picture>& picture) { return picture ? "accepted" : picture.error().what; }

TEST(PictureLibrary, counts_the_pictures_in_use) {
  PictureLibrary sut;
  std::vector<Picture> held;
  const std::string bytes = png_of(64, 64, std::string(std::size_t{4} * 64 * 64, 'x'));
  for (int i = 0; i < 3; ++i) held.push_back(*sut.of_bytes(bytes));
  EXPECT_EQ(sut.bytes(), std::size_t{3} * 4 * 64 * 64);
  held.clear();
  EXPECT_EQ(sut.bytes(), 0U);
}

TEST(PictureLibrary, a_mesh_asks_for_no_more_work_than_pictures_may_take) {
  PictureLibrary sut;
  const Picture held = *sut.of_bytes(four_pixels());
  sut.begin_mesh();
  EXPECT_THAT(refusal(sut.of_bytes(damaged_png(4096))), HasSubstr("it is damaged: "));
  const std::string beyond = "with its 4096 x 4096 pixels the cell's textures would need more than 128 MiB";
  EXPECT_EQ(refusal(sut.of_bytes(damaged_png(4096))), beyond);  // the one in use takes some
  EXPECT_TRUE(sut.of_bytes(four_pixels()));
  sut.begin_mesh();
  EXPECT_THAT(refusal(sut.of_bytes(damaged_png(4096))), HasSubstr("it is damaged: "));
}

TEST(PictureLibrary, a_file_that_failed_is_tried_again_with_the_next_mesh) {
  const TemporaryHome home;
  PictureLibrary sut;
  for (const std::string& bad : {std::string("GIF89a"), damaged_png(16)}) {
    sut.begin_mesh();
    const std::string first = refusal(sut.of_file(home.write("four.png", bad)));
    EXPECT_NE(first, "accepted");
    EXPECT_EQ(refusal(sut.of_file(home.write("four.png", four_pixels()))), first);
    sut.begin_mesh();
    EXPECT_TRUE(sut.of_file(home.root() / "four.png"));
  }
}

}  // namespace
}  // namespace cellmirror
