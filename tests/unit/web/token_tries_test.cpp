#include "ipc/web/token_tries.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace cellmirror::web {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using Verdict = TokenTries::Verdict;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr const char* kGuess = "guess-guess-guess-guess";

struct TokenTriesTest : testing::Test {
  Verdict tries(const std::string& given, const std::string& peer) {
    checked = sut.check(given, kToken, peer, now);
    return checked.verdict;
  }
  void pass(double s) { now = now + Nanoseconds(static_cast<std::int64_t>(1e9 * s)); }
  // Sends wrong tokens until one is not checked; returns the number of checked ones.
  int exhaust(const std::string& peer) {
    int wrong = 0;
    while (wrong < 1000 && tries(kGuess, peer) == Verdict::wrong) ++wrong;
    return wrong;
  }

  TokenTries sut;
  TokenTries::Check checked;
  Timestamp now{1'000'000'000};
};

TEST_F(TokenTriesTest, ChecksOnlyTheFirstTokensOfAPeer) {
  EXPECT_EQ(exhaust("10.0.0.1"), static_cast<int>(kWrongTokensAtOnce));
  EXPECT_EQ(checked.verdict, Verdict::unread);
  EXPECT_GE(checked.wait_s, 1);
  EXPECT_LE(checked.wait_s, 1 / kWrongTokensPerSecond);
  EXPECT_EQ(tries(kToken, "10.0.0.1"), Verdict::unread) << "otherwise guesses would have no cost";
}

TEST_F(TokenTriesTest, NeverDelaysARightTokenOfAnotherPeer) {
  exhaust("10.0.0.1");
  for (int i = 0; i < 12'000; ++i) {
    EXPECT_EQ(tries(kGuess, "10.0.0.1"), Verdict::unread);
    ASSERT_EQ(tries(kToken, "10.0.0.2"), Verdict::right) << i;
  }
  // Not even while many addresses send wrong tokens.
  for (int i = 0; i < 2000; ++i) {
    tries(kGuess, "10.1.0." + std::to_string(i));
    ASSERT_EQ(tries(kToken, "10.0.0.2"), Verdict::right) << i;
  }
}

TEST_F(TokenTriesTest, ChecksAgainAfterTheWait) {
  exhaust("10.0.0.1");
  const int wait_s = checked.wait_s;
  pass(0.5 * wait_s);
  EXPECT_EQ(tries(kToken, "10.0.0.1"), Verdict::unread);
  pass(0.5 * wait_s);
  EXPECT_EQ(tries(kToken, "10.0.0.1"), Verdict::right);
  EXPECT_EQ(tries(kGuess, "10.0.0.1"), Verdict::wrong);
  EXPECT_EQ(tries(kGuess, "10.0.0.1"), Verdict::unread) << "one more for each wait";
}

TEST_F(TokenTriesTest, BoundsWrongTokensOfAllPeersTogether) {
  int wrong = 0;
  for (int round = 0; round < 10; ++round) {
    for (int peer = 0; peer < 200; ++peer) wrong += tries(kGuess, std::to_string(peer)) == Verdict::wrong ? 1 : 0;
  }
  EXPECT_LE(wrong, 200 + 2 * kAllWrongTokensPerSecond) << "the first of each, and a few";
}

TEST_F(TokenTriesTest, AMissingTokenIsNotAGuess) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(tries("", "10.0.0.1"), Verdict::none);
  EXPECT_EQ(tries(kToken, "10.0.0.1"), Verdict::right);
  EXPECT_THAT(sut.take_reports(now), IsEmpty());
}

TEST_F(TokenTriesTest, ReportsTheAddressAndTheCountButNeverTheToken) {
  tries(kGuess, "10.0.0.1");
  EXPECT_THAT(sut.take_reports(now), ElementsAre("1 wrong token from 10.0.0.1"));
  EXPECT_THAT(sut.take_reports(now), IsEmpty());
  for (int i = 0; i < 500; ++i) {
    tries(kGuess, "10.0.0.1");
    pass(0.01);
    EXPECT_THAT(sut.take_reports(now), IsEmpty()) << "not one line per attempt";
  }
  pass(5);
  const auto lines = sut.take_reports(now);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0], HasSubstr("9 wrong tokens from 10.0.0.1 within 10 s, and 491 more attempts"));
  EXPECT_THAT(lines[0], Not(HasSubstr(kGuess)));
}

TEST_F(TokenTriesTest, KeepsAndReportsABoundedNumberOfPeers) {
  std::uint64_t reported = 0;
  for (int i = 0; i < 20'000; ++i) tries(kGuess, "10.0." + std::to_string(i / 256) + "." + std::to_string(i % 256));
  const auto lines = sut.take_reports(now);
  ASSERT_THAT(lines, SizeIs(TokenTries::kMostLines + 1));
  for (const std::string& line : lines) reported += std::stoull(line);
  EXPECT_EQ(reported, 20'000U) << "including the forgotten peers";
  EXPECT_THAT(lines.back(), HasSubstr("from other addresses"));
}

TEST_F(TokenTriesTest, ReportsAPeerNameAsPrintableText) {
  tries(kGuess, "\x1b[2Ja\n");
  const auto lines = sut.take_reports(now);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_EQ(lines[0].find_first_of("\x1b\n"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror::web
