#include "ipc/control/queue_answer.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

TEST(QueueAnswer, ComesBackAsItWas) {
  const auto read = parse_queue_answer(queue_answer_text({3, 2'147'483'647, "taken \"by\" another", ""}));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->script_queue, 3);
  EXPECT_EQ(read->reply_queue, 2'147'483'647);
  EXPECT_EQ(read->script_problem, "taken \"by\" another");
  EXPECT_EQ(read->reply_problem, "");
}

TEST(QueueAnswer, NoiseIsRefused) {
  for (const char* text :
       {"", "[]", "{}", "null", R"({"script_queue":-1,"reply_queue":1,"script_problem":"","reply_problem":""})",
        R"({"script_queue":2147483648,"reply_queue":1,"script_problem":"","reply_problem":""})",
        R"({"script_queue":1.5,"reply_queue":1,"script_problem":"","reply_problem":""})",
        R"({"script_queue":1,"reply_queue":1,"script_problem":1,"reply_problem":""})"}) {
    EXPECT_FALSE(parse_queue_answer(text)) << text;
  }
}

}  // namespace
}  // namespace cellmirror
