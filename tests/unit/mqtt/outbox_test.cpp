#include "drivers/mqtt/outbox.hpp"

#include <gtest/gtest.h>

namespace cellmirror::mqtt {
namespace {

using Kind = Outgoing::Kind;

Outgoing message(Kind kind, std::string topic, std::string payload) {
  return {.kind = kind, .topic = std::move(topic), .payload = std::move(payload)};
}

std::vector<std::string> all_of(Outbox& box) {
  std::vector<std::string> out;
  while (auto next = box.take()) out.push_back(next->topic + "=" + next->payload);
  return out;
}

TEST(MqttOutbox, GivesRetainedThenRepliesThenEventsThenJointStates) {
  Outbox box;
  box.put(message(Kind::joint_states, "j", "1"));
  box.put(message(Kind::event, "e", "1"));
  box.put(message(Kind::reply, "r", "1"));
  box.put(message(Kind::retained, "s", "1"));
  box.put(message(Kind::event, "e", "2"));
  EXPECT_EQ(all_of(box), (std::vector<std::string>{"s=1", "r=1", "e=1", "e=2", "j=1"}));
  EXPECT_EQ(box.size(), 0U);
  EXPECT_EQ(box.bytes(), 0U);
}

TEST(MqttOutbox, KeepsOfRetainedMessagesTheNewestOfEachTopic) {
  Outbox box;
  for (int i = 0; i < 10'000; ++i) box.put(message(Kind::retained, "summary", std::to_string(i)));
  EXPECT_EQ(all_of(box), std::vector<std::string>{"summary=9999"});
  EXPECT_EQ(box.counters().replaced, 9999U);
}

TEST(MqttOutbox, IsBoundedWhateverComes) {
  Outbox box;
  for (int i = 0; i < 100'000; ++i) {
    box.put(message(Kind::event, "e", std::to_string(i)));
    box.put(message(Kind::joint_states, "j", std::to_string(i)));
    box.put(message(Kind::reply, "r", std::string(20'000, 'x')));
  }
  EXPECT_LE(box.bytes(), 3 * Outbox::kMostBytes);
  EXPECT_EQ(box.counters().events_dropped, 100'000U - Outbox::kMostEvents);
  EXPECT_EQ(box.counters().joint_states_dropped, 100'000U - Outbox::kMostJointStates);
  EXPECT_GT(box.counters().replies_dropped, 99'000U);
  const std::vector<std::string> left = all_of(box);
  EXPECT_EQ(left.back(), "j=99999") << "the newest ones are left";
}

TEST(MqttOutbox, TakesBackWhatWasNotConfirmed) {
  Outbox box;
  box.put(message(Kind::event, "e", "3"));
  box.put(message(Kind::retained, "summary", "new"));
  box.give_back({message(Kind::event, "e", "1"), message(Kind::retained, "summary", "old"),
                 message(Kind::joint_states, "j", "1"), message(Kind::event, "e", "2"),
                 message(Kind::other, "x", "1")});
  EXPECT_EQ(all_of(box), (std::vector<std::string>{"summary=new", "e=1", "e=2", "e=3"}));
  EXPECT_EQ(box.counters().joint_states_dropped, 1U);
}

}  // namespace
}  // namespace cellmirror::mqtt
