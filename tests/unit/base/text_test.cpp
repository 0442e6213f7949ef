#include "rt_core/base/text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rt_core/base/counted.hpp"

namespace cellmirror {
namespace {

TEST(NumberOf, OneThingIsOne) {
  EXPECT_EQ(number_of(0, "file"), "0 files");
  EXPECT_EQ(number_of(1, "file"), "1 file");
  EXPECT_EQ(number_of(2, "file"), "2 files");
  EXPECT_EQ(number_of(1, "body", "bodies"), "1 body");
  EXPECT_EQ(number_of(12, "body", "bodies"), "12 bodies");
}

TEST(ParseNumber, TakesDecimalAndExponentFormOnly) {
  EXPECT_DOUBLE_EQ(*parse_number("1.507E-03"), 1.507e-3);
  EXPECT_DOUBLE_EQ(*parse_number("+.5"), 0.5);
  EXPECT_DOUBLE_EQ(*parse_number("-7."), -7.0);
  for (const char* wrong :
       {"", "+", "-", "+-1", "++1", "1 ", " 1", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "1a"}) {
    EXPECT_FALSE(parse_number(wrong)) << wrong;
  }
}

TEST(ParseInteger, TakesDecimalAndHexadecimal) {
  EXPECT_EQ(*parse_integer("-12"), -12);
  EXPECT_EQ(*parse_integer("0x92f"), 2351);
  for (const char* wrong : {"", "+", "+-1", "0x", "0x-1", "1.0", "99999999999999999999", "12a"}) {
    EXPECT_FALSE(parse_integer(wrong)) << wrong;
  }
}

TEST(Nearest, NamesWhatAPersonMayHaveMeantAndNothingElse) {
  const std::vector<std::string> names = {"PUMA_762", "PUMA_560", "MANTEC_R3", "ZELLENKRAN"};
  EXPECT_EQ(nearest("PUMA_726", names), (std::vector<std::string>{"PUMA_762"}));
  EXPECT_EQ(did_you_mean("puma_762", names), "did you mean PUMA_762 or PUMA_560?");  // the nearest first
  EXPECT_EQ(did_you_mean("Q", names), "");
  const std::vector<std::string> short_names = {"ARM", "A", "LIFT"};
  EXPECT_EQ(did_you_mean("a", short_names), "did you mean A?") << "two letters make any name out of one";
  EXPECT_EQ(did_you_mean("x", short_names), "");
  EXPECT_EQ(did_you_mean("ARN", short_names), "did you mean ARM?");
  EXPECT_EQ(did_you_mean("xyz", std::vector<std::string>{"xyz_m", "rpy_rad"}), "did you mean xyz_m?");
  EXPECT_EQ(did_you_mean("bus", short_names), "");
  EXPECT_EQ(did_you_mean("AMR", short_names), "did you mean ARM?") << "in the wrong order";
  EXPECT_EQ(did_you_mean("POS_RBO", std::vector<std::string>{"POS_ROB"}), "did you mean POS_ROB?");
  EXPECT_TRUE(nearest(std::string(100'000, 'P'), names).empty());
}

TEST(Printable, ShowsBytesFromOutsideHarmlesslyAndBounded) {
  EXPECT_EQ(printable("a\x1b[31m\xff"), "a\\x1b[31m\\xff");
  EXPECT_EQ(printable(std::string(1000, 'x'), 4), "xxxx... (1000 bytes)");
}

TEST(Text, ComparesKeywordsWithoutRegardToCase) {
  EXPECT_TRUE(equal_ignoring_case("Robact", "ROBACT"));
  EXPECT_FALSE(equal_ignoring_case("ROBACT", "ROBACTS"));
  EXPECT_EQ(trimmed(" \t a b \r\n"), "a b");
  EXPECT_EQ(lower_case("AbC"), "abc");
}

}  // namespace
}  // namespace cellmirror
