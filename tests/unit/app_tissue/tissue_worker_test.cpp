// What the simulation of tissue shows to those who draw it.
#include "app/workers/tissue_worker.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "rt_core/rt/watchdog.hpp"
#include "tests/support/tissue/bodies.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

using namespace std::chrono_literals;

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
  sut.start();
  std::shared_ptr<const TissueView> first;
  for (int i = 0; i < 2000 && !first; ++i) {
    std::this_thread::sleep_for(5ms);
    first = sut.view();
  }
  ASSERT_TRUE(first);
  std::this_thread::sleep_for(1500ms);  // longer than shapes are made without being asked for
  const std::shared_ptr<const TissueReport> report = sut.reports().latest();
  ASSERT_TRUE(report);
  EXPECT_GT(report->state.step, first->step + 100) << "it goes on";
  EXPECT_GE(sut.view()->step, report->state.step);
  sut.stop();
}

}  // namespace
}  // namespace cellmirror::app
