#include "rt_core/volume/user_table.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror::volume {
namespace {

std::string errors_of(std::string_view text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_user_table(text, "user1.lut", diagnostics));
  EXPECT_FALSE(diagnostics.ok());
  return diagnostics.text();
}

TEST(UserTable, RowsWithCommentsAndAnyBlanks) {
  Diagnostics diagnostics;
  const auto table =
      parse_user_table("# bone\r\n-100 0 0 0 0\r\n\n  +300.5\t1 0.5 .25 1e-1 # half\n", "u", diagnostics);
  ASSERT_TRUE(table) << diagnostics.text();
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_EQ(table->rows[1], (VolumeUserRow{300.5, {1.0F, 0.5F, 0.25F}, 0.1F}));
  EXPECT_TRUE(diagnostics.all().empty());
}

TEST(UserTable, ErrorsNameFileAndLine) {
  EXPECT_NE(errors_of("0 0 0 0 0\n1 2 0 0 0\n").find("user1.lut:2"), std::string::npos);
  EXPECT_NE(errors_of("0 0 0 0 0\n1 0 0 0\n").find("4 numbers"), std::string::npos);
  EXPECT_NE(errors_of("0 0 0 0 0\n1 0 0 0 0 0\n").find("6 numbers"), std::string::npos);
  EXPECT_NE(errors_of("0 0 0 0 0\n1 0 x 0 0\n").find("'x'"), std::string::npos);
  EXPECT_NE(errors_of("0 0 0 0 0\n0 0 0 0 0\n").find("rising"), std::string::npos);
  EXPECT_NE(errors_of("0 0 0 0 0\n").find("2 rows"), std::string::npos);
  EXPECT_NE(errors_of("").find("2 rows"), std::string::npos);
}

TEST(UserTable, AllErrorsOfAFileAreTold) {
  const std::string text = errors_of("a 0 0 0 0\n0 0 0 0 0\nnan 0 0 0 0\ninf 0 0 0 0\n1e300 0 0 0 0\n");
  for (const char* const line : {":1", ":3", ":4", ":5"}) EXPECT_NE(text.find(line), std::string::npos) << text;
}

TEST(UserTable, SizesAreBounded) {
  std::string rows;
  for (std::size_t i = 0; i <= kMostUserRows; ++i) rows += std::to_string(i) + " 0 0 0 0\n";
  EXPECT_NE(errors_of(rows).find("more than 4096 rows"), std::string::npos);
  EXPECT_NE(errors_of(std::string(kLongestUserTable + 1, '#')).find("1 MiB"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::volume
