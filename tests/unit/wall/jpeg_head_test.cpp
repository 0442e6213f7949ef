#include "app/wall/jpeg_head.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cellmirror::app {
namespace {

// By ITU-T T.81: SOI, APP0 of JFIF, DQT (cut short), SOF0 of 640 x 480 with three components.
const std::vector<std::uint8_t> kHead = {0xFF, 0xD8, 0xFF, 0xE0, 0, 16,   'J',  'F', 'I', 'F',  0,    1,    1,    0,  0,
                                         1,    0,    1,    0,    0, 0xFF, 0xDB, 0,   3,   0x00, 0xFF, 0xC0, 0,    17, 8,
                                         0x01, 0xE0, 0x02, 0x80, 3, 1,    0x22, 0,   2,   0x11, 1,    3,    0x11, 1};

TEST(JpegHead, TellsTheSize) { EXPECT_EQ(jpeg_size(kHead), (JpegSize{640, 480})); }

TEST(JpegHead, RefusesWhatIsCutOrIsNoJpeg) {
  for (std::size_t size = 0; size < 33; ++size)
    EXPECT_EQ(jpeg_size(std::span(kHead).first(size)), std::nullopt) << size;
  std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13};
  EXPECT_EQ(jpeg_size(png), std::nullopt);
  std::vector<std::uint8_t> scan = kHead;
  scan[3] = 0xDA;  // a scan before any frame
  EXPECT_EQ(jpeg_size(scan), std::nullopt);
}

TEST(JpegHead, RefusesSizesThatAreNotShown) {
  std::vector<std::uint8_t> none = kHead;
  none[32] = none[33] = 0;
  EXPECT_EQ(jpeg_size(none), std::nullopt);
  std::vector<std::uint8_t> huge = kHead;
  huge[32] = 0xFF;
  EXPECT_EQ(jpeg_size(huge), std::nullopt);
}

}  // namespace
}  // namespace cellmirror::app
