#include "app/new_cell/names.hpp"

#include <gtest/gtest.h>

#include "rt_core/base/shell_word.hpp"

namespace cellmirror::app {
namespace {

TEST(NewCellNames, PlainNamesAreWhatNeedsNoQuotingAnywhere) {
  for (const char* name : {"a", "line_3", "A-1", "_x"}) EXPECT_TRUE(is_plain_name(name)) << name;
  for (const char* name : {"", "-a", "..", "a b", "a.b", "a/b", "$x", "\xC3\xBC"})
    EXPECT_FALSE(is_plain_name(name)) << name;
  EXPECT_TRUE(is_plain_name(std::string(63, 'x')));
  EXPECT_FALSE(is_plain_name(std::string(64, 'x')));
}

TEST(NewCellNames, FileNamesLoseWhatIsNotPlain) {
  EXPECT_EQ(plain_file_name("axis drive.eds"), "axis_drive.eds");
  EXPECT_EQ(plain_file_name("../../x"), "_._.._x");
  EXPECT_EQ(plain_file_name(""), "_");
  EXPECT_EQ(plain_file_name(std::string(500, 'a') + ".eds").size(), 100U);
  EXPECT_TRUE(plain_file_name(std::string(500, 'a') + ".eds").ends_with(".eds"));
}

TEST(NewCellNames, TextsAreQuotedForTomlAndForAShell) {
  EXPECT_EQ(toml_text("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
  EXPECT_EQ(toml_text("\xC3\xBC\xE2"
                      "b\x7F"),
            "\"\xC3\xBC\\ufffdb\\u007f\"");
  EXPECT_EQ(shell_word("rt/joint_states"), "rt/joint_states");
  EXPECT_EQ(shell_word("$(x)"), "'$(x)'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(NewCellNames, NumbersReadBackAsThemselves) {
  EXPECT_EQ(number_text(1.0), "1.0");
  EXPECT_EQ(number_text(-0.0), "0.0");
  EXPECT_EQ(std::stod(number_text(10430.378350470453)), 10430.378350470453);
  EXPECT_EQ(std::stod(number_text(1e-300)), 1e-300);
}

}  // namespace
}  // namespace cellmirror::app
