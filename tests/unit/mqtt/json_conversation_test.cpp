#include "drivers/mqtt/json_conversation.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cellmirror::mqtt {
namespace {

using namespace std::chrono_literals;

class JsonTalk : public testing::Test {
 protected:
  JsonTalk() {
    config_.commands = true;
    config_.commands_per_s = 10;
    start();
  }
  void start() {
    talk_ = std::make_shared<JsonConversation>(
        config_, Identity{"c1", "default", "pc", "1"}, clock_,
        CommandHandlers{.take =
                            [this](std::string command, CommandAnswer answer) {
                              taken_.push_back(std::move(command));
                              answers_.push_back(std::move(answer));
                            },
                        .refused = [this](std::string_view, const std::string& why) { refused_.push_back(why); }},
        [] {});
  }
  std::vector<Outgoing> sent() {
    std::vector<Outgoing> out;
    while (auto next = talk_->next()) out.push_back(*std::move(next));
    return out;
  }
  std::uint64_t counter(const std::string& name) {
    for (const auto& [key, value] : talk_->counters()) {
      if (key == name) return value;
    }
    ADD_FAILURE() << name;
    return 0;
  }
  void hear(std::string_view payload, bool retained = false, std::string_view to = {}, std::string_view data = {}) {
    talk_->received({.topic = "cellmirror/c1/command",
                     .payload = payload,
                     .retained = retained,
                     .response_topic = to,
                     .correlation = data});
  }

  MqttConfig config_;
  ManualClock clock_;
  std::shared_ptr<JsonConversation> talk_;
  std::vector<std::string> taken_;
  std::vector<CommandAnswer> answers_;
  std::vector<std::string> refused_;
};

TEST_F(JsonTalk, ACommandIsAnsweredWhereItsCallerAsks) {
  hear(R"({"command": "A", "id": 1})");
  hear(R"({"command": "B", "id": 2})", false, "cellmirror/c1/reply/me", "corr");
  EXPECT_EQ(taken_, (std::vector<std::string>{"A", "B"}));
  EXPECT_TRUE(sent().empty()) << "not before it is done";
  answers_[1](false, "no");
  answers_[0](true, "");
  const auto replies = sent();
  ASSERT_EQ(replies.size(), 2U);
  EXPECT_EQ(replies[0].topic, "cellmirror/c1/reply/me");
  EXPECT_EQ(replies[0].correlation, "corr");
  EXPECT_NE(replies[0].payload.find(R"("done":false,"text":"no")"), std::string::npos);
  EXPECT_NE(replies[0].payload.find(R"("id":2)"), std::string::npos);
  EXPECT_EQ(replies[1].topic, "cellmirror/c1/reply");
  EXPECT_EQ(replies[1].qos, 1);
}

TEST_F(JsonTalk, RubbishIsRefusedWithAnAnswerAndAnEntryInTheLog) {
  hear("rubbish");
  hear(R"({"command": "A"})", false, "cellmirror/other/command");
  hear(R"({"command": "A"})", false, "cellmirror/c1/reply", std::string(1000, 'x'));
  EXPECT_TRUE(taken_.empty());
  EXPECT_EQ(refused_.size(), 3U);
  const auto replies = sent();
  ASSERT_EQ(replies.size(), 3U);
  for (const Outgoing& reply : replies) EXPECT_EQ(reply.topic, "cellmirror/c1/reply");
  EXPECT_EQ(counter("commands_refused"), 3U);
}

TEST_F(JsonTalk, WhatTheBrokerHasKeptIsNeverExecuted) {
  hear(R"({"command": "A"})", true);
  EXPECT_TRUE(taken_.empty());
  EXPECT_EQ(counter("retained_ignored"), 1U);
  EXPECT_TRUE(sent().empty());
}

TEST_F(JsonTalk, NothingIsHeardWhereCommandsAreNotAllowed) {
  config_.commands = false;
  start();
  EXPECT_TRUE(talk_->subscriptions().empty());
  hear(R"({"command": "A"})");
  EXPECT_TRUE(taken_.empty());
}

TEST_F(JsonTalk, OfAFloodFewAreTakenAndFewAnswered) {
  for (int i = 0; i < 10'000; ++i) hear(R"({"command": "A"})");
  EXPECT_EQ(taken_.size(), 20U);
  EXPECT_EQ(counter("commands_flooded"), 9'980U);
  EXPECT_EQ(refused_.size(), 1U) << "one line a second in the log of commands";
  EXPECT_EQ(sent().size(), 1U);
}

TEST_F(JsonTalk, SoManyWaitForTheirAnswerAndNoMore) {
  for (std::size_t i = 0; i < 2 * JsonConversation::kMostWaitingCommands; ++i) {
    clock_.advance(1s);
    hear(R"({"command": "A"})");
  }
  EXPECT_EQ(taken_.size(), JsonConversation::kMostWaitingCommands);
  answers_.front()(true, "");
  clock_.advance(1s);
  hear(R"({"command": "B"})");
  EXPECT_EQ(taken_.back(), "B");
}

TEST_F(JsonTalk, AnAnswerAfterTheEndHarmsNobody) {
  hear(R"({"command": "A"})");
  talk_.reset();
  answers_[0](true, "");
}

TEST_F(JsonTalk, StreamsThatAreLostAndComeBackAreEvents) {
  CellSummary summary;
  summary.robots = {{.id = "R1", .mirrored = true, .state = DataState::fresh}, {.id = "R2"}};
  talk_->summary(summary, "{}");
  summary.robots[0].state = DataState::lost;
  talk_->summary(summary, "{}");
  talk_->summary(summary, "{}");
  summary.robots[0].state = DataState::fresh;
  summary.loop.faults = 1;
  talk_->summary(summary, "{}");
  std::vector<std::string> events;
  for (const Outgoing& message : sent()) {
    if (message.kind == Outgoing::Kind::event) events.push_back(message.payload);
  }
  ASSERT_EQ(events.size(), 4U);
  EXPECT_NE(events[0].find(R"("state":"fresh","was":"none")"), std::string::npos);
  EXPECT_NE(events[1].find(R"("state":"lost","was":"fresh")"), std::string::npos);
  EXPECT_NE(events[2].find(R"("event":"fault","number":3)"), std::string::npos);
  EXPECT_NE(events[3].find(R"("state":"fresh","was":"lost")"), std::string::npos);
}

TEST_F(JsonTalk, TheBirthIsToldAtEachConnectionAndNowAndThen) {
  talk_->connected();
  auto first = sent();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_TRUE(first[0].retain);
  EXPECT_EQ(first[0].topic, "cellmirror/c1/state");
  talk_->lost({});
  talk_->summary({}, "{}");
  EXPECT_EQ(sent().size(), 1U) << "the summary";
  talk_->connected();
  EXPECT_EQ(sent().size(), 1U);
  clock_.advance(JsonConversation::kBirthEvery);
  talk_->summary({}, "{}");
  EXPECT_EQ(sent().size(), 2U) << "others may have put something in its place";
  EXPECT_EQ(talk_->begin().payload, R"({"online":false,"reason":"lost"})");
}

}  // namespace
}  // namespace cellmirror::mqtt
