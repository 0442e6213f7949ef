#include "app/recording/ros2_schema.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace cellmirror::app {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

std::string text_of(const Result<FlatMessage>& message) {
  if (!message) return "error: " + message.error().what;
  std::string out;
  for (const FlatValue& value : *message) out += value.path + "=" + value.text + ";";
  return out;
}

TEST(Ros2Schema, ReadsAlignedValuesOfEitherByteOrder) {
  const auto schema = Ros2Schema::parse("p/msg/A", "uint8 a\nint16 b # two\nuint8 KIND=3\nfloat32 c 0.5\nstring s\n");
  ASSERT_TRUE(schema) << schema.error().text();
  EXPECT_EQ(text_of(schema->flatten(bytes({0, 1, 0, 0, 7, 0, 0xFE, 0xFF, 0, 0, 0xC0, 0x3F, 3, 0, 0, 0, 'h', 'i', 0}))),
            "a=7;b=-2;c=1.5;s=hi;");
  EXPECT_EQ(text_of(schema->flatten(bytes({0, 0, 0, 0, 7, 0, 0xFF, 0xFE, 0x3F, 0xC0, 0, 0, 0, 0, 0, 3, 'h', 'i', 0}))),
            "a=7;b=-2;c=1.5;s=hi;");
}

TEST(Ros2Schema, ReadsArraysAndTypesOfOtherPackages) {
  const auto schema = Ros2Schema::parse("p/msg/A",
                                        "q/B[2] b\nuint8[<=4] c\nbool[] d\n====\nMSG: q/B\nuint8 x\nC y\n"
                                        "====\nMSG: q/msg/C\nuint8 z\n");
  ASSERT_TRUE(schema) << schema.error().text();
  EXPECT_EQ(text_of(schema->flatten(bytes({0, 1, 0, 0, 1, 2, 3, 4, 2, 0, 0, 0, 8, 9, 0, 0, 1, 0, 0, 0, 1}))),
            "b[0].x=1;b[0].y.z=2;b[1].x=3;b[1].y.z=4;c[0]=8;c[1]=9;d[0]=true;");
}

TEST(Ros2Schema, RefusesTypesThatContainThemselvesOrAreNotThere) {
  EXPECT_FALSE(Ros2Schema::parse("p/A", "A a\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "B b\n===\nMSG: p/B\nA[] a\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "q/B b\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "uint8[ a\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "uint8[-1] a\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "uint8\n"));
  EXPECT_FALSE(Ros2Schema::parse("p/A", "uint8 a\n===\nno heading\n"));
}

TEST(Ros2Schema, RefusesMessagesThatAreCutOffOrLie) {
  const auto schema = Ros2Schema::parse("p/A", "float64[] a\nstring b\n");
  ASSERT_TRUE(schema);
  EXPECT_FALSE(schema->flatten(bytes({})));
  EXPECT_FALSE(schema->flatten(bytes({0, 9, 0, 0})));
  EXPECT_FALSE(schema->flatten(bytes({0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF})));
  EXPECT_FALSE(schema->flatten(bytes({0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 'a'})));
}

// Structures that take no bytes must not be walked for ever.
TEST(Ros2Schema, AnAvalancheOfEmptyStructuresEnds) {
  std::string text;
  for (int i = 0; i < 14; ++i) {
    if (i > 0) text += "===\nMSG: p/T" + std::to_string(i) + "\n";
    for (int field = 0; field < 20; ++field) text += "T" + std::to_string(i + 1) + " f" + std::to_string(field) + "\n";
  }
  text += "===\nMSG: p/T14\nuint8[0] nothing\n";
  const auto schema = Ros2Schema::parse("p/T0", text);
  ASSERT_TRUE(schema) << schema.error().text();
  EXPECT_FALSE(schema->flatten(bytes({0, 1, 0, 0})));
}

TEST(Ros2Schema, PicturesAreNotTakenApart) {
  const auto schema = Ros2Schema::parse("p/A", "uint8[] data\nuint8 end\n");
  ASSERT_TRUE(schema);
  std::vector<std::byte> message = bytes({0, 1, 0, 0, 100, 0, 0, 0});
  message.resize(message.size() + 100);
  message.push_back(std::byte{5});
  EXPECT_EQ(text_of(schema->flatten(message)), "data=100 bytes;end=5;");
}

TEST(FlattenJson, NamesMembersAndElements) {
  EXPECT_EQ(text_of(flatten_json(R"({"a":{"b":[1,2.5,"x"]},"c":true,"d":null})")),
            "a.b[0]=1;a.b[1]=2.5;a.b[2]=x;c=true;d=;");
  EXPECT_FALSE(flatten_json("{"));
  EXPECT_FALSE(flatten_json(std::string(1000, '[') + std::string(1000, ']')));
}

}  // namespace
}  // namespace cellmirror::app
