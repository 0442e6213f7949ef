#include "config/volume_message/slice_message.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cellmirror {
namespace {

SliceHead full_head() {
  SliceHead head;
  head.patient = "a\nb";
  head.series = "1.2.3";
  head.instance = "1.2.3.4";
  head.modality = "CT";
  head.rows = 512;
  head.columns = 256;
  head.bits_allocated = 16;
  head.bits_stored = 12;
  head.high_bit = 11;
  head.is_signed = true;
  head.rescaled = true;
  head.slope = 0.5;
  head.intercept = -1024;
  head.position = {1, 2, 3};
  head.orientation = {1, 0, 0, 0, 1, 0};
  head.spacing = {0.7, 0.5};
  return head;
}

TEST(SliceHeadMessage, ComesBackAsItWas) {
  const auto sut = decode_slice_head(encode_slice_head(full_head()));
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->patient, "a\nb");
  EXPECT_EQ(sut->columns, 256U);
  EXPECT_TRUE(sut->is_signed);
  EXPECT_EQ(sut->slope, 0.5);
  EXPECT_EQ(sut->orientation, full_head().orientation);
  EXPECT_EQ(sut->spacing, full_head().spacing);
  SliceHead bare;
  const auto without = decode_slice_head(encode_slice_head(bare));
  ASSERT_TRUE(without);
  EXPECT_FALSE(without->position);
}

TEST(SliceHeadMessage, IsNoneWhereItIsCutOrLonger) {
  const std::string whole = encode_slice_head(full_head());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_FALSE(decode_slice_head(whole.substr(0, i))) << i;
  EXPECT_FALSE(decode_slice_head(whole + "x"));
}

TEST(SliceHeadMessage, IsNoneWithNumbersThatAreNoneOrTooLarge) {
  SliceHead head = full_head();
  head.position = {1, std::numeric_limits<double>::quiet_NaN(), 3};
  EXPECT_FALSE(decode_slice_head(encode_slice_head(head)));
  head = full_head();
  head.slope = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(decode_slice_head(encode_slice_head(head)));
  head = full_head();
  head.rows = 70000;
  EXPECT_FALSE(decode_slice_head(encode_slice_head(head)));
}

TEST(SliceErrorMessage, IsPrintable) {
  const auto sut = decode_slice_error(encode_slice_error({"a\x1b[31m", "b\n"}));
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->what, "a\\x1b[31m");
  EXPECT_EQ(sut->remedy, "b\\x0a");
  EXPECT_FALSE(decode_slice_error(encode_slice_error({"", ""})));
}

}  // namespace
}  // namespace cellmirror
