// What the simulation of tissue shows to those who draw it.
#include "app/workers/tissue_worker.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "rt_core/rt/scheduling.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "tests/support/tissue/bodies.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

using namespace std::chrono_literals;

// Of the thread of this process that has the name; -1: there is none.
int policy_of(const std::string& name) {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "comm");
    std::string comm;
    std::getline(file, comm);
    if (comm == name) return sched_getscheduler(std::stoi(task.path().filename()));
  }
  return -1;
}

TEST(TissueWorkerView, TheFirstOneAfterAWhileIsFresh) {
  Diagnostics diagnostics;
  std::optional<Cell> cell = build_cell("[[node]]\nname = \"Table\"\n", std::make_shared<TextFiles>(), diagnostics);
  ASSERT_TRUE(cell) << diagnostics.text();
  SystemClock clock;
  Watchdog watchdog{1s, {}};
  engine::Engine engine(watchdog, {.robots = 1});
  engine::TickReader& ticks = engine.subscribe("tissue");
  Board<CellState> board;
  auto made = TissueWorker::make({tissue_bodies::ball(0.03, 0.015)}, {}, std::make_shared<geometry::SolidLibrary>(),
                                 engine, ticks, board, clock);
  ASSERT_TRUE(made) << made.error().text();
  TissueWorker& sut = **made;
  CycleContext context;
  context.now = clock.now();
  context.period = 1ms;
  engine.run(context);
  auto state = std::make_shared<CellState>();
  state->cell = cell->compile();
  board.publish(std::move(state));
  constexpr int kPriority = 5;
  sut.start(RealTimePolicy::prefer, kPriority);
  std::shared_ptr<const TissueView> first;
  for (int i = 0; i < 2000 && !first; ++i) {
    std::this_thread::sleep_for(5ms);
    first = sut.view();
  }
  ASSERT_TRUE(first);
  const bool allowed = probe_real_time_scheduling(kPriority).ok;
  EXPECT_EQ(policy_of("tissue"), allowed ? SCHED_FIFO : SCHED_OTHER) << "before what takes longer";
  std::this_thread::sleep_for(1500ms);  // longer than shapes are made without being asked for
  const std::shared_ptr<const TissueReport> report = sut.reports().latest();
  ASSERT_TRUE(report);
  EXPECT_GT(report->state.step, first->step + 100) << "it goes on";
  EXPECT_GE(sut.view()->step, report->state.step);
  sut.stop();
}

}  // namespace
}  // namespace cellmirror::app
