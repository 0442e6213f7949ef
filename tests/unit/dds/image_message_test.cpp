#include "drivers/dds/image_message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace cellmirror::dds {
namespace {

// sensor_msgs/CompressedImage by hand: encapsulation CDR_LE, stamp, frame_id "c", format "jpeg", four octets.
constexpr std::array<std::uint8_t, 43> kPicture = {0, 1,   0, 0, 5, 0, 0,    0,    7,    0,    0,   0,   2,   0, 0,
                                                   0, 'c', 0, 0, 0, 5, 0,    0,    0,    'j',  'p', 'e', 'g', 0, 0,
                                                   0, 0,   4, 0, 0, 0, 0xFF, 0xD8, 0xFF, 0xC0, 9,   9,   9};

std::span<const std::byte> first(std::size_t size) { return std::as_bytes(std::span(kPicture)).first(size); }

TEST(CompressedImageMessage, IsReadWithWhatLiesBehindIt) {
  CompressedImageView sut;
  ASSERT_EQ(decode(first(kPicture.size()), sut), CdrFault::none);
  EXPECT_EQ(sut.stamp, (RosTime{5, 7}));
  EXPECT_EQ(sut.frame_id, "c");
  EXPECT_EQ(sut.format, "jpeg");
  ASSERT_EQ(sut.data.size(), 4u);
  EXPECT_EQ(sut.data[1], 0xD8);
}

TEST(CompressedImageMessage, IsRefusedWhereItIsCut) {
  for (std::size_t size = 0; size < 40; ++size) {
    CompressedImageView sut;
    EXPECT_NE(decode(first(size), sut), CdrFault::none) << size;
  }
}

TEST(CompressedImageMessage, IsRefusedWhereItsLengthIsALie) {
  auto bytes = kPicture;
  std::memset(bytes.data() + 32, 0xFF, 4);
  CompressedImageView sut;
  EXPECT_NE(decode(std::as_bytes(std::span(bytes)), sut), CdrFault::none);
}

}  // namespace
}  // namespace cellmirror::dds
