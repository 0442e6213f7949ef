#include "rt_core/base/utc_text.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

TEST(UtcText, IsCutAndNotRounded) {
  EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00Z");
  EXPECT_EQ(utc_text(951'782'399'999'999'999), "2000-02-28T23:59:59Z");
  EXPECT_EQ(utc_text_ms(951'782'400'000'000'000), "2000-02-29T00:00:00.000Z");
  EXPECT_EQ(utc_text_ms(951'782'400'007'999'999), "2000-02-29T00:00:00.007Z");
}

}  // namespace
}  // namespace cellmirror
