// Pictures, as Cyclone DDS sees them.
#include <gtest/gtest.h>

#include "cyclone_peer.hpp"
#include "drivers/dds/image_output.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

EncodedImage picture(std::size_t bytes) {
  EncodedImage made;
  made.width = 640;
  made.height = 480;
  made.posture_time = SystemClock().now();
  made.bytes.resize(bytes);
  for (std::size_t i = 0; i < bytes; ++i) made.bytes[i] = static_cast<std::uint8_t>(i * 31 % 251);
  return made;
}

class DdsImagesTest : public testing::Test {
 protected:
  void SetUp() override {
    config_.pictures.view = 3;
    auto made = make_image_output(config_);
    ASSERT_TRUE(made) << made.error().text();
    sut_ = std::move(*made);
  }
  [[nodiscard]] std::uint64_t counter(const std::string& name) const {
    for (const auto& [key, value] : sut_->counters()) {
      if (key == name) return value;
    }
    ADD_FAILURE() << name;
    return 0;
  }

  DdsOutputConfig config_{.enabled = true, .domain = test_domain(6)};
  CyclonePeer peer_{test_domain(6)};
  std::unique_ptr<ImageOutput> sut_;
};

// A picture is larger than a datagram.
TEST_F(DdsImagesTest, WholePicturesArriveByteByByte) {
  EXPECT_FALSE(sut_->watched());
  const dds_entity_t reader = peer_.image_reader(config_.pictures.topic);
  ASSERT_TRUE(eventually([&] { return sut_->watched() && CyclonePeer::matched_writers(reader) == 1; }));
  const EncodedImage sent = picture(300'000);
  std::vector<PlainImage> seen;
  ASSERT_TRUE(eventually([&] {
    sut_->publish_image(sent);
    for (auto& one : CyclonePeer::take_images(reader)) seen.push_back(std::move(one));
    return !seen.empty();
  }));
  EXPECT_EQ(seen[0].format, "jpeg");
  EXPECT_EQ(seen[0].frame_id, "view_3");
  EXPECT_GT(seen[0].sec, 1'600'000'000);
  EXPECT_EQ(seen[0].data, sent.bytes);
  EXPECT_EQ(counter("readers"), 1U);
}

TEST_F(DdsImagesTest, WhatNoReaderWouldTakeIsCounted) {
  sut_->publish_image(picture(2'000'000));
  EXPECT_EQ(counter("too_large"), 1U);
  EXPECT_EQ(counter("dropped"), 1U);
  EXPECT_EQ(counter("sent"), 0U);
}

}  // namespace
}  // namespace cellmirror::dds::test
