// Workers follow the tick: always the newest, none twice, and they rest where there is nothing to do.
#include "app/workers/tick_worker.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/rt/broadcast.hpp"

namespace cellmirror::app {
namespace {

// A tick by hand: the test publishes, the job tells what it saw.
struct TickWorkerTest : testing::Test, TickJob {
  TickWorkerTest() {
    auto cell_state = std::make_shared<CellState>();
    board.publish(cell_state);
  }
  bool wanted(const CellState& /*cell_state*/) override {
    const std::scoped_lock lock(mutex);
    ++asked;
    news.notify_all();
    return want;
  }
  void run(const CellState& /*cell_state*/, const engine::TickState& tick) override {
    std::unique_lock lock(mutex);
    seen.push_back(tick.tick);
    news.notify_all();
    news.wait(lock, [this] { return !hold; });
  }
  void publish(std::uint64_t number) {
    engine::TickState& state = ticks.writable();
    state.tick = number;
    state.time = clock.now();
    ticks.publish();
  }
  template <class Condition>
  bool eventually(Condition condition) {
    std::unique_lock lock(mutex);
    return news.wait_for(lock, std::chrono::seconds(20), condition);
  }
  void set_hold(bool value) {
    const std::scoped_lock lock(mutex);
    hold = value;
    news.notify_all();
  }
  std::unique_ptr<TickWorker> start() {
    return std::make_unique<TickWorker>(*this, reader, board, clock, std::chrono::milliseconds(1));
  }

  SystemClock clock;
  Board<CellState> board;
  Broadcast<engine::TickState> ticks;
  engine::TickReader reader{"test", ticks.subscribe()};
  std::mutex mutex;
  std::condition_variable news;
  bool want = true;
  bool hold = false;
  int asked = 0;
  std::vector<std::uint64_t> seen;
};

using Ticks = std::vector<std::uint64_t>;

TEST_F(TickWorkerTest, TakesTheNewestTickAndCountsThoseItWasTooBusyFor) {
  hold = true;
  publish(1);
  const auto sut = start();
  ASSERT_TRUE(eventually([this] { return seen == Ticks{1}; }));
  for (std::uint64_t i = 2; i <= 5; ++i) publish(i);
  set_hold(false);
  ASSERT_TRUE(eventually([this] { return seen == Ticks{1, 5}; }));
  publish(6);
  ASSERT_TRUE(eventually([this] { return seen == Ticks{1, 5, 6}; }));
  EXPECT_EQ(sut->skipped(), 3U);
}

TEST_F(TickWorkerTest, DoesNoTickTwice) {
  publish(7);
  const auto sut = start();
  ASSERT_TRUE(eventually([this] { return asked > 5; }));
  EXPECT_EQ(seen, Ticks{7});
  EXPECT_EQ(sut->skipped(), 0U);
}

TEST_F(TickWorkerTest, WaitsForTheFirstTick) {
  const auto sut = start();
  ASSERT_TRUE(eventually([this] { return asked > 2; }));
  EXPECT_TRUE(seen.empty());
}

TEST_F(TickWorkerTest, RestsWhereNothingIsWantedAndCountsNothingAsSkipped) {
  want = false;
  publish(1);
  const auto sut = start();
  ASSERT_TRUE(eventually([this] { return asked > 2; }));
  publish(50);
  {
    const std::scoped_lock lock(mutex);
    EXPECT_TRUE(seen.empty());
    want = true;
  }
  ASSERT_TRUE(eventually([this] { return seen == Ticks{50}; }));
  EXPECT_EQ(sut->skipped(), 0U);
}

TEST_F(TickWorkerTest, EndsWhileItRests) {
  want = false;
  auto sut = start();
  sut.reset();
  SUCCEED();
}

}  // namespace
}  // namespace cellmirror::app
