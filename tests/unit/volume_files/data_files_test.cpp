#include "config/volume/data_files.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

using Names = std::vector<std::string>;

TEST(PatternOfDataFiles, CountsUpAndDownWithAndWithoutZeros) {
  EXPECT_EQ(*names_of_pattern("q.%d", 9, 11, 1), (Names{"q.9", "q.10", "q.11"}));
  EXPECT_EQ(*names_of_pattern("q%03d.raw", 11, 9, -1), (Names{"q011.raw", "q010.raw", "q009.raw"}));
  EXPECT_EQ(*names_of_pattern("%2d", 8, 10, 2), (Names{" 8", "10"}));
}

TEST(PatternOfDataFiles, IsRefusedWithoutOneNumberOrWithTooMany) {
  for (const char* pattern : {"a.raw", "%s", "%d%d", "%", "%5", "%n"})
    EXPECT_FALSE(names_of_pattern(pattern, 1, 2, 1)) << pattern;
  EXPECT_FALSE(names_of_pattern("%d", 1, 2, 0));
  EXPECT_FALSE(names_of_pattern("%d", 2, 1, 1));
  EXPECT_FALSE(names_of_pattern("%d", 1, 5000, 1));
}

}  // namespace
}  // namespace cellmirror
