// What people write to inject faults into nodes.
#include "app/gateway/node_fault_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace cellmirror::app {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

TEST(NodeFaultText, NamesAKindAndItsKeys) {
  EXPECT_EQ(parse_node_fault("death")->kind, NodeFaultKind::death);
  const auto late = parse_node_fault("delay:s=0.25,only=sdo");
  ASSERT_TRUE(late) << late.error().text();
  EXPECT_EQ(late->by, 250ms);
  EXPECT_EQ(late->only, NodeFrames::sdo);
  EXPECT_EQ(parse_node_fault("loss:p=0.5")->probability, 0.5);
  EXPECT_EQ(parse_node_fault("loss")->probability, 1);
  EXPECT_EQ(parse_node_fault("emergency:code=0x2310")->code, 0x2310);
  const auto bit = parse_node_fault("stuck:bit=31,value=1");
  ASSERT_TRUE(bit) << bit.error().text();
  EXPECT_EQ(bit->input, 31);
  EXPECT_FALSE(bit->analogue);
  const auto channel = parse_node_fault("stuck:channel=8,value=-32768");
  ASSERT_TRUE(channel) << channel.error().text();
  EXPECT_EQ(channel->input, 7);
  EXPECT_TRUE(channel->analogue);
  EXPECT_EQ(channel->value, -32768);
}

TEST(NodeFaultText, TellsWhatIsWrong) {
  const std::pair<std::string, const char*> wrong[] = {
      {"", "there is no fault"},
      {"deth", "known: death, loss, delay, emergency, stuck"},
      {"death:s=1", "s is no key of this fault; it has none"},
      {"delay", "s= is missing"},
      {"delay:s=-1", "no number from 0 to 10"},
      {"delay:s=nan", "no number"},
      {"delay:s=1,s=2", "comes twice"},
      {"delay:s=1,only=tpdo", "known: all, heartbeat, sdo, pdo, emergency"},
      {"loss:p", "no key=value"},
      {"loss:q=1", "known: p, only"},
      {"emergency:code=0x12345", "no number from 1 to 65535"},
      {"stuck:value=1", "bit= or channel="},
      {"stuck:bit=1,channel=1,value=1", "bit= or channel="},
      {"stuck:bit=1,value=2", "0 or 1"},
      {"stuck:bit=32,value=1", "no number from 0 to 31"},
      {std::string(500, 'x'), "too long"}};
  for (const auto& [text, expected] : wrong) {
    const auto fault = parse_node_fault(text);
    ASSERT_FALSE(fault) << text;
    EXPECT_THAT(fault.error().text(), HasSubstr(expected)) << text;
  }
}

TEST(FaultRequest, HasANodeAndAFaultOrItsEnd) {
  const auto request =
      fault_request({"fault", {{"node", "11"}, {"fault", "death"}, {"for_s", "2.5"}, {"channel", "socketcan:can0"}}});
  ASSERT_TRUE(request) << request.error().text();
  EXPECT_EQ(request->order.node, 11);
  EXPECT_EQ(request->order.fault.lasts, 2500ms);
  EXPECT_EQ(request->channel, "socketcan:can0");
  EXPECT_FALSE(request->order.ends_all);
  const auto end = fault_request({"fault", {{"node", "11"}, {"end", "true"}}});
  ASSERT_TRUE(end) << end.error().text();
  EXPECT_TRUE(end->order.ends_all);
  EXPECT_FALSE(fault_request({"fault", {{"node", "128"}, {"end", "true"}}}));
  EXPECT_FALSE(fault_request({"fault", {{"fault", "death"}}}));
  EXPECT_FALSE(fault_request({"fault", {{"node", "1"}, {"fault", "death"}, {"for_s", "-1"}}}));
  EXPECT_THAT(fault_request({"fault", {{"node", "1"}, {"for", "1"}}}).error().text(), HasSubstr("known: node"));
}

}  // namespace
}  // namespace cellmirror::app
