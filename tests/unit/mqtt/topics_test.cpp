#include "drivers/mqtt/topics.hpp"

#include <gtest/gtest.h>

namespace cellmirror::mqtt {
namespace {

TEST(Topics, AreBelowThePrefixAndTheCell) {
  const Topics topics("plant/hall_2", "cell 1");
  EXPECT_EQ(topics.state(), "plant/hall_2/cell 1/state");
  EXPECT_EQ(topics.summary(), "plant/hall_2/cell 1/summary");
  EXPECT_EQ(topics.event(), "plant/hall_2/cell 1/event");
  EXPECT_EQ(topics.command(), "plant/hall_2/cell 1/command");
  EXPECT_EQ(topics.joint_states("R1"), "plant/hall_2/cell 1/joint_states/R1");
}

TEST(Topics, NamesCannotMakeOtherLevelsOrWildcards) {
  EXPECT_EQ(topic_level("a/b"), "a%2Fb");
  EXPECT_EQ(topic_level("+"), "%2B");
  EXPECT_EQ(topic_level("#"), "%23");
  EXPECT_EQ(topic_level("50%"), "50%25");
  EXPECT_EQ(topic_level("$SYS"), "%24SYS");
  EXPECT_EQ(topic_level("a$"), "a$");
  EXPECT_EQ(topic_level(std::string_view("a\0b\n", 4)), "a%00b%0A");
  EXPECT_EQ(topic_level("\xC2\x85"), "%C2%85") << "a control character of C1";
  EXPECT_EQ(topic_level("Gr\xC3\xBC\xC3\x9F"), "Gr\xC3\xBC\xC3\x9F");
  EXPECT_EQ(topic_level("\xFF"), "%FF");
  EXPECT_EQ(topic_level(""), "%00");
  EXPECT_LE(topic_level(std::string(10'000, '/')).size(), kMostLevelBytes + 2);
}

TEST(Topics, AnswersGoNowhereElse) {
  const Topics topics("p", "c");
  EXPECT_TRUE(topics.is_reply("p/c/reply"));
  EXPECT_TRUE(topics.is_reply("p/c/reply/client-7"));
  EXPECT_FALSE(topics.is_reply("p/c/replyx"));
  EXPECT_FALSE(topics.is_reply("p/c/state"));
  EXPECT_FALSE(topics.is_reply("p/other/command"));
  EXPECT_FALSE(topics.is_reply("p/c/reply/+"));
  EXPECT_FALSE(topics.is_reply("p/c/reply/\xFF"));
  EXPECT_FALSE(topics.is_reply("p/c/reply/" + std::string(2000, 'x')));
}

}  // namespace
}  // namespace cellmirror::mqtt
