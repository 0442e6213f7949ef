#include "rt_core/base/utf8.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace cellmirror {
namespace {

// RFC 3629, section 4: the bounds of each row of its syntax.
TEST(Utf8, TakesExactlyWellFormedCharacters) {
  const auto bytes = [](std::string_view text) {
    const auto character = utf8_character(text);
    return character ? character->bytes : 0;
  };
  EXPECT_EQ(bytes("\x7F"), 1u);
  EXPECT_EQ(bytes("\xC2\x80"), 2u);
  EXPECT_EQ(bytes("\xDF\xBF"), 2u);
  EXPECT_EQ(bytes("\xE0\xA0\x80"), 3u);
  EXPECT_EQ(bytes("\xED\x9F\xBF"), 3u);
  EXPECT_EQ(bytes("\xEE\x80\x80"), 3u);
  EXPECT_EQ(bytes("\xF0\x90\x80\x80"), 4u);
  EXPECT_EQ(bytes("\xF4\x8F\xBF\xBF"), 4u);
  for (const auto bad : {"\x80", "\xBF", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
                         "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xC2", "\xC2\x41", "\xE2\x82"}) {
    EXPECT_EQ(bytes(bad), 0u);
  }
}

TEST(Utf8, IsToldFromOtherBytes) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("Gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x9a\x80"));
  for (const char* text : {"\x96", "\xc3", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88"})
    EXPECT_FALSE(is_utf8(text));
}

TEST(Utf8, IsCutBetweenCharacters) {
  EXPECT_EQ(cut_utf8("a\xC3\xA4", 3), "a\xC3\xA4");
  EXPECT_EQ(cut_utf8("a\xC3\xA4", 2), "a");
}

TEST(Utf8, CanBeDrawnWhateverTheBytes) {
  EXPECT_EQ(drawable_utf8("\xC3\xA4 1.3 m"), "\xC3\xA4 1.3 m");
  EXPECT_EQ(drawable_utf8("a\x01\xFF\xC0\x80z"), "a????z");
  EXPECT_EQ(drawable_utf8("a\x7F\xC2\x9B"
                          "b"),
            "a??b");
  EXPECT_EQ(drawable_utf8("\xE2\x82"), "??");
  EXPECT_EQ(drawable_utf8("abcdef", 3), "abc\xE2\x80\xA6");
  EXPECT_EQ(drawable_utf8("abc", 3), "abc");
}

}  // namespace
}  // namespace cellmirror
