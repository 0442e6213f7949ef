#include "app/wall/wall_inbox.hpp"

#include <gtest/gtest.h>

#include "tests/unit/wall/wall_messages.hpp"

namespace cellmirror::app {
namespace {

TEST(WallInbox, GivesWhatCameOnce) {
  WallInbox sut;
  TestGateway a{"s1", "A"};
  sut.received(a.message(0));
  sut.received(a.message(0.5));
  sut.gone("s2");
  const auto taken = sut.take();
  ASSERT_EQ(taken.messages.size(), 2u);
  EXPECT_EQ(taken.messages[1].summary.sequence, 2u);
  EXPECT_EQ(taken.gone, std::vector<std::string>{"s2"});
  EXPECT_TRUE(sut.take().messages.empty());
}

TEST(WallInbox, AFloodOfOneSenderTakesNothingFromOthers) {
  WallInbox sut;
  TestGateway flood{"flood", "A"};
  TestGateway good{"good", "B"};
  std::size_t of_flood = 0;
  std::size_t of_good = 0;
  std::uint64_t dropped = 0;
  for (int second = 0; second < 10; ++second) {
    for (int i = 0; i < 1000; ++i) sut.received(flood.message(second + 1e-3 * i));
    sut.received(good.message(second));
    sut.received(good.message(second + 0.5));
    const auto taken = sut.take();
    for (const WallMessage& message : taken.messages) (message.sender == "good" ? of_good : of_flood) += 1;
    dropped += taken.refused.at("flood").dropped;
    EXPECT_FALSE(taken.refused.contains("good"));
  }
  EXPECT_EQ(of_good, 20u);
  EXPECT_LE(of_flood, static_cast<std::size_t>(kSummariesPerSecond * 12));
  EXPECT_GE(of_flood, static_cast<std::size_t>(kSummariesPerSecond * 9));
  EXPECT_EQ(of_flood + dropped, 10'000u);
}

TEST(WallInbox, IsBoundedInMessagesAndSenders) {
  WallInbox sut;
  for (std::size_t i = 0; i < 3 * kMostWallSenders; ++i) {
    TestGateway one{"s" + std::to_string(i), "A"};
    for (int k = 0; k < 4; ++k) sut.received(one.message(0));
    sut.rejected(one.sender, "no summary");
  }
  const auto taken = sut.take();
  EXPECT_LE(taken.messages.size(), kMostWaitingMessages);
  EXPECT_LE(taken.refused.size(), kMostWallSenders);
  EXPECT_GT(taken.left_out, 0u);
}

TEST(WallInbox, IsBoundedInBytes) {
  WallInbox sut;
  for (std::size_t i = 0; i < 2000; ++i) {
    TestGateway one{"s" + std::to_string(i), "A"};
    WallMessage message = one.message(0);
    message.bytes = kMostSummaryBytes;
    sut.received(std::move(message));
  }
  EXPECT_LE(sut.take().messages.size(), kMostWaitingBytes / kMostSummaryBytes + 1);
}

TEST(WallInbox, TellsTheReasonOfTheFirstThatIsRefused) {
  WallInbox sut;
  sut.rejected("s", "not \x01 JSON");
  sut.rejected("s", "other");
  const auto taken = sut.take();
  EXPECT_EQ(taken.refused.at("s").rejected, 2u);
  EXPECT_EQ(taken.refused.at("s").why, "not \\x01 JSON");
}

}  // namespace
}  // namespace cellmirror::app
