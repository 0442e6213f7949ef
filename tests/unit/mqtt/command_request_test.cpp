#include "drivers/mqtt/command_request.hpp"

#include <gtest/gtest.h>

#include "drivers/mqtt/reconnect_delay.hpp"

namespace cellmirror::mqtt {
namespace {

using namespace std::chrono_literals;

TEST(MqttCommand, IsATextWithAnId) {
  std::string id;
  const auto with_text = parse_command(R"({"command": "ROBACT R1", "id": "a\"1"})", id);
  ASSERT_TRUE(with_text);
  EXPECT_EQ(with_text->command, "ROBACT R1");
  EXPECT_EQ(id, R"("a\"1")");
  ASSERT_TRUE(parse_command(R"({"command": "ROBACT R1", "id": 7})", id));
  EXPECT_EQ(id, "7");
  ASSERT_TRUE(parse_command(R"({"command": "ROBACT R1"})", id));
  EXPECT_EQ(id, "");
}

TEST(MqttCommand, WhatIsRefusedKeepsItsIdWhereItHasOne) {
  std::string id;
  for (const char* payload : {"", "rubbish", "[1]", "7", "{", R"({"command": 7})", R"({"command": "A", "id": []})",
                              R"({"command": "A", "id": 1.5})", R"({"command": "A", "retain": true})", "\xFF\xFE"}) {
    const auto refused = parse_command(payload, id);
    ASSERT_FALSE(refused) << payload;
    EXPECT_FALSE(refused.error().what.empty());
  }
  EXPECT_FALSE(parse_command(R"({"id": 7})", id));
  EXPECT_EQ(id, "7");
  EXPECT_FALSE(parse_command(R"({"command": "A", "id": ")" + std::string(kMostIdBytes + 1, 'x') + R"("})", id));
  EXPECT_EQ(id, "");
  EXPECT_FALSE(parse_command(std::string(kMostCommandBytes + 1, ' '), id));
  EXPECT_FALSE(parse_command(std::string(kMostCommandBytes, '['), id)) << "deep arrays";
}

TEST(MqttCommandGate, AdmitsTheRateAndSomeAtOnce) {
  CommandGate gate(10);
  ManualClock clock;
  int admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += gate.admit(clock.now()) ? 1 : 0;
  EXPECT_EQ(admitted, 20);
  for (int i = 0; i < 100; ++i) {
    clock.advance(10ms);
    admitted += gate.admit(clock.now()) ? 1 : 0;
  }
  EXPECT_NEAR(admitted, 30, 1) << "ten in a second of hundred";
  clock.advance(1h);
  admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += gate.admit(clock.now()) ? 1 : 0;
  EXPECT_EQ(admitted, 20) << "silence saves up no more";
}

TEST(MqttReconnectDelay, DoublesUpToItsLimitAndBeginsAgainAfterAConnectionThatLasted) {
  ReconnectDelay delay;
  EXPECT_EQ(delay.after(0s), 1s);
  EXPECT_EQ(delay.after(0s), 2s);
  EXPECT_EQ(delay.after(100ms), 4s) << "ended at once: another client may have the same name";
  for (int i = 0; i < 100; ++i) EXPECT_LE(delay.after(0s), ReconnectDelay::kLongest);
  EXPECT_EQ(delay.after(0s), 30s);
  EXPECT_EQ(delay.after(1min), 1s);
}

}  // namespace
}  // namespace cellmirror::mqtt
