#include "app/wall/thumbnails.hpp"

#include <gtest/gtest.h>

#include "tests/unit/wall/wall_messages.hpp"

namespace cellmirror::app {
namespace {

std::vector<std::uint8_t> jpeg(std::size_t bytes) {
  std::vector<std::uint8_t> out = {0xFF, 0xD8, 0xFF, 0xC0, 0, 17, 8, 0, 100, 0, 200, 3};
  out.resize(bytes, 1);
  return out;
}

TEST(ThumbnailsOfCells, KeepTheNewestOnceASecond) {
  Thumbnails sut({"A"});
  EXPECT_EQ(sut.report("A")->number, 0u);
  for (int i = 0; i < 30; ++i) sut.receive("A", jpeg(1000 + static_cast<std::size_t>(i)), at(0.1 * i));
  EXPECT_EQ(sut.report("A")->number, 3u);
  EXPECT_EQ(sut.report("A")->left_out, 27u);
  ASSERT_TRUE(sut.newest("A"));
  EXPECT_EQ(sut.newest("A")->number, 3u);
}

TEST(ThumbnailsOfCells, RefuseWhatIsTooLargeOrNoJpeg) {
  Thumbnails sut({"A"});
  sut.receive("A", jpeg(kMostThumbnailBytes + 1), at(0));
  sut.receive("A", std::vector<std::uint8_t>(1000, 7), at(1));
  sut.receive("A", {}, at(2));
  EXPECT_EQ(sut.report("A")->refused, 3u);
  EXPECT_FALSE(sut.newest("A"));
  sut.receive("A", jpeg(kMostThumbnailBytes), at(2));
  EXPECT_TRUE(sut.newest("A"));
}

TEST(ThumbnailsOfCells, IgnoreOtherCells) {
  Thumbnails sut({"A"});
  sut.receive("B", jpeg(1000), at(0));
  EXPECT_FALSE(sut.newest("B"));
  EXPECT_FALSE(sut.report("B"));
}

}  // namespace
}  // namespace cellmirror::app
