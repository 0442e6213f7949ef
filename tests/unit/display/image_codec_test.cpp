#include "drivers/display/image_codec.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include "tests/unit/display/picture_probe.hpp"

namespace cellmirror::display {
namespace {

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.rgba.insert(image.rgba.end(), {static_cast<std::uint8_t>(255 * x / width),
                                           static_cast<std::uint8_t>(255 * y / height), 90, 255});
    }
  }
  return image;
}

TEST(DisplayCodec, PngKeepsEveryPixel) {
  ImageEncoder sut;
  const Image image = gradient(61, 37);
  for (const int level : {0, 1, 9, 50, -3}) {
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(sut.encode(image, {.format = ImageFormat::png, .png_level = level}, bytes));
    const std::array<std::uint8_t, 8> signature = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};  // PNG, 5.2
    ASSERT_TRUE(std::equal(signature.begin(), signature.end(), bytes.begin()));
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_memory(&read, bytes.data(), bytes.size()));
    EXPECT_EQ(read.width, 61U);
    EXPECT_EQ(read.height, 37U);
    read.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> back(image.rgba.size());
    ASSERT_TRUE(png_image_finish_read(&read, nullptr, back.data(), 0, nullptr));
    EXPECT_EQ(back, image.rgba);
  }
}

TEST(DisplayCodec, JpegIsNearlyThePicture) {
  ImageEncoder sut;
  const Image image = gradient(160, 90);
  std::vector<std::uint8_t> coarse;
  std::vector<std::uint8_t> fine;
  ASSERT_TRUE(sut.encode(image, {.jpeg_quality = 20}, coarse));
  ASSERT_TRUE(sut.encode(image, {.jpeg_quality = 95}, fine));
  EXPECT_LT(coarse.size(), fine.size());
  EXPECT_EQ(fine[0], 0xFF);  // SOI, ITU-T T.81, B.1.1.3
  EXPECT_EQ(fine[1], 0xD8);
  Image back{160, 90, std::vector<std::uint8_t>(image.rgba.size())};
  tjhandle decoder = tjInitDecompress();
  ASSERT_EQ(tjDecompress2(decoder, fine.data(), fine.size(), back.rgba.data(), 160, 0, 90, TJPF_RGBA, 0), 0);
  tjDestroy(decoder);
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 160; ++x) ASSERT_FALSE(differ(image.pixel(x, y), back.pixel(x, y), 14)) << x << ' ' << y;
  }
}

TEST(DisplayCodec, RefusesAPictureWithoutItsPixels) {
  ImageEncoder sut;
  std::vector<std::uint8_t> bytes;
  for (const ImageFormat format : {ImageFormat::jpeg, ImageFormat::png}) {
    EXPECT_FALSE(sut.encode(Image{}, {.format = format}, bytes));
    EXPECT_FALSE(sut.encode(Image{10, 10, std::vector<std::uint8_t>(399)}, {.format = format}, bytes));
    EXPECT_FALSE(sut.encode(Image{-10, -10, std::vector<std::uint8_t>(400)}, {.format = format}, bytes));
    EXPECT_FALSE(sut.encode(Image{5000, 1, std::vector<std::uint8_t>(20000)}, {.format = format}, bytes));
  }
}

}  // namespace
}  // namespace cellmirror::display
