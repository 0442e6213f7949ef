// What ticks published is put together again to the bit, from any tick on that has a start state before it.
#include "app/playback/published_ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

#include "tests/unit/engine/commands.hpp"

namespace cellmirror::app {
namespace {

constexpr Nanoseconds kTickPeriod{2'000'000};

class PublishedTicksTest : public testing::Test {
 protected:
  PublishedTicksTest() {
    for (std::size_t slot = 0; slot < 2; ++slot) send_robot(*engine_, slot, engine::robot_of(3, -2, 2));
    engine_->send(engine::SetMode{.slot = 1, .mode = engine::RobotMode::mirrored});
    tick(3);
  }

  void tick(int times) {
    for (int i = 0; i < times; ++i) {
      now_ = now_ + kTickPeriod;
      const JointSample sample = engine::sample_of_curve(now_ - Nanoseconds(100'000), cycle_ + 1);
      if (sample.sequence % 3 != 0) engine_->inlet(1).push(sample);
      engine::run_cycle(*engine_, now_, cycle_, 0, kTickPeriod);
      for (std::size_t j = 0; j < 3; ++j) published_[now_][j] = ticks_.newest().robots[1].joints[j].position;
    }
  }

  std::vector<std::byte> message() {
    std::vector<std::byte> out{std::byte{engine::kInputsVersion}};
    engine_->inputs().drain(out);
    return out;
  }

  // How many ticks are given; each with the positions that it had published, to the bit.
  int play(PublishedTicks& ticks, ByteSpan bytes) {
    int count = 0;
    const auto more = ticks.take(bytes, [&](Timestamp time, bool after_gap) {
      after_gap_ = after_gap_ || after_gap;
      const engine::TickState& state = ticks.state();
      EXPECT_EQ(state.time, time);
      EXPECT_EQ(state.robots[1].mode, engine::RobotMode::mirrored);
      for (std::size_t j = 0; j < 3; ++j) {
        const double recorded = published_.at(time)[j];
        EXPECT_EQ(std::memcmp(&state.robots[1].joints[j].position, &recorded, sizeof recorded), 0);
      }
      ++count;
      return true;
    });
    EXPECT_TRUE(more.has_value());
    return count;
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<engine::Engine> engine_ =
      std::make_unique<engine::Engine>(watchdog_, engine::EngineCapacity{.robots = 4});
  engine::TickReader& ticks_ = engine_->subscribe("test");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
  std::map<Timestamp, std::array<double, 3>> published_;
  bool after_gap_ = false;
  PublishedTicks sut_;
};

TEST_F(PublishedTicksTest, EachIsAsItWas) {
  engine_->inputs().request_start();
  tick(300);
  const auto first = message();
  tick(200);
  const auto second = message();
  EXPECT_EQ(play(sut_, first), 300);
  EXPECT_TRUE(after_gap_) << "the first one";
  after_gap_ = false;
  EXPECT_EQ(play(sut_, second), 200);
  EXPECT_FALSE(after_gap_);
}

TEST_F(PublishedTicksTest, BeginsAtAStartStateAndNotBefore) {
  engine_->inputs().request_start();
  tick(50);
  static_cast<void>(message());
  tick(50);
  const auto without = message();
  engine_->inputs().request_start();
  tick(50);
  const auto with = message();
  EXPECT_EQ(play(sut_, without), 0);
  EXPECT_EQ(play(sut_, with), 50);
}

TEST_F(PublishedTicksTest, AfterAGapItWaitsForTheNextStartState) {
  engine_->inputs().request_start();
  tick(50);
  const auto before = message();
  tick(20);
  static_cast<void>(message());  // lost
  tick(20);
  const auto behind = message();
  engine_->inputs().request_start();
  tick(20);
  const auto begun = message();
  EXPECT_EQ(play(sut_, before), 50);
  after_gap_ = false;
  EXPECT_EQ(play(sut_, behind), 0);
  EXPECT_EQ(play(sut_, begun), 20);
  EXPECT_TRUE(after_gap_);
}

// As it is where the tick itself found no room for a record.
TEST_F(PublishedTicksTest, AStartStateRightAfterAGapIsTaken) {
  engine_->inputs().request_start();
  tick(50);
  const auto before = message();
  tick(20);
  static_cast<void>(message());  // lost
  engine_->inputs().request_start();
  tick(20);
  const auto begun = message();
  EXPECT_EQ(play(sut_, before), 50);
  after_gap_ = false;
  EXPECT_EQ(play(sut_, begun), 20);
  EXPECT_TRUE(after_gap_);
}

TEST_F(PublishedTicksTest, TheReaderEndsItWhereItLikes) {
  engine_->inputs().request_start();
  tick(50);
  int count = 0;
  const auto more = sut_.take(message(), [&](Timestamp, bool) { return ++count < 7; });
  ASSERT_TRUE(more.has_value());
  EXPECT_FALSE(*more);
  EXPECT_EQ(count, 7);
}

TEST_F(PublishedTicksTest, WhatIsNotSoundIsAnErrorWhereverItBegins) {
  engine_->inputs().request_start();
  tick(10);
  const auto whole = message();
  for (std::size_t at = 1; at < whole.size(); at += 37) {
    PublishedTicks ticks;
    auto cut = whole;
    cut.resize(at);
    static_cast<void>(ticks.take(cut, [&](Timestamp, bool) { return true; }));
    auto flipped = whole;
    flipped[at] ^= std::byte{0xFF};
    static_cast<void>(ticks.take(flipped, [&](Timestamp, bool) { return static_cast<void>(ticks.state()), true; }));
  }
  auto other = whole;
  other[0] = std::byte{99};
  EXPECT_FALSE(sut_.take(other, [](Timestamp, bool) { return true; }));
}

}  // namespace
}  // namespace cellmirror::app
