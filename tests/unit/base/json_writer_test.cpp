#include "rt_core/base/json_writer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace cellmirror {
namespace {

TEST(JsonWriter, PutsCommasWhereTheyBelong) {
  JsonWriter sut;
  sut.begin_object().member("a", 1).key("list").begin_array().value(true).begin_array().end_array().null().end_array();
  sut.member("texts", std::vector<std::string>{"x", "y"}).member("b", "c").end_object();
  EXPECT_EQ(sut.take(), R"({"a":1,"list":[true,[],null],"texts":["x","y"],"b":"c"})");
}

TEST(JsonWriter, WritesNumbersAsLongAsTheyAreWanted) {
  const auto written = [](JsonWriter sut, double number) { return sut.value(number).take(); };
  EXPECT_EQ(written(JsonWriter(), 0.1 + 0.2), "0.3");
  EXPECT_EQ(written(JsonWriter(JsonWriter::kExact), 0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(written(JsonWriter(7), double{0.1F}), "0.1");
  EXPECT_EQ(written(JsonWriter(), std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(JsonWriter().fixed(1.23456, 3).take(), "1.235");
  EXPECT_EQ(JsonWriter().fixed(std::numeric_limits<double>::quiet_NaN(), 3).take(), "null");
  EXPECT_EQ(JsonWriter().value(Eigen::Vector3d(1, -2, 0.5)).take(), "[1,-2,0.5]");
}

TEST(JsonWriter, EscapesTextAndReplacesWhatIsNoUtf8) {
  EXPECT_EQ(JsonWriter()
                .value("a\"b\\c\n\x01"
                       "d")
                .take(),
            R"("a\"b\\c\u000a\u0001d")");
  EXPECT_EQ(JsonWriter().value("\xC3\xA4 \xFFz").take(), "\"\xC3\xA4 \xEF\xBF\xBDz\"");
  EXPECT_EQ(JsonWriter().value("").take(), "\"\"");
}

TEST(JsonWriter, GivesALongListPieceByPieceALineAnElement) {
  JsonWriter sut;
  std::string all = sut.begin_object().key("rows").begin_array().take();
  for (int i = 0; i < 2; ++i) all += sut.line().begin_object().member("i", i).end_object().take();
  all += sut.line().end_array().member("n", 2).end_object().take();
  EXPECT_EQ(all, "{\"rows\":[\n{\"i\":0},\n{\"i\":1}\n],\"n\":2}");
}

}  // namespace
}  // namespace cellmirror
