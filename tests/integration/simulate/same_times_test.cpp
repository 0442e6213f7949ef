// Robot programs run beside real time, as in the gateway, and off line: the same commands in the same order, and the
// same times within a tick.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/gateway/cell_owner.hpp"
#include "app/simulation/simulation.hpp"
#include "config/cell_file.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;
using program::ProgramEvent;

constexpr double kTick = 1e-3;         // s
constexpr double kTolerance = 1.5e-3;  // s: a tick, and that neither clock begins on one
constexpr int kTries = 3;              // a machine that stands still for a moment tells nothing about us
constexpr std::chrono::seconds kPatience{60};

LoadedCell load(const fs::path& file) {
  Diagnostics diagnostics;
  auto cell = load_cell(file, diagnostics);
  EXPECT_TRUE(cell) << diagnostics.text();
  return std::move(*cell);
}

// What a robot's programs did, and how long after its first event.
struct Step {
  std::string what;
  double time_s = 0;
};
using Steps = std::map<std::string, std::vector<Step>>;

Steps relative(Steps steps) {
  for (auto& [robot, list] : steps) {
    const double first = list.front().time_s;
    for (Step& step : list) step.time_s -= first;
  }
  return steps;
}

// The owner and the tick in their threads.
Steps run_in_real_time(const fs::path& cell_file, const std::string& script, std::size_t ends) {
  LoadedCell loaded = load(cell_file);
  SystemClock clock;
  Watchdog watchdog(std::chrono::milliseconds(100), {});
  const auto engine = std::make_unique<engine::Engine>(watchdog);
  PictureBoard board;
  std::mutex mutex;
  Steps steps;
  std::size_t ended = 0;
  CellOwner owner(CellOwner::Parts{
      .cell = std::move(loaded.cell),
      .home = loaded.home,
      .streams = {},
      .haptics = {},
      .views = {},
      .collision = {},
      .foot_switches = {},
      .engine = *engine,
      .board = board,
      .clock = clock,
      .instance = {},
      .save_flight_record = [](std::string_view) -> Result<void> { return {}; },
      .reply = [](std::int64_t, const ScriptReply&) {},
      .program_event =
          [&](const ProgramEvent& event) {
            const std::scoped_lock lock(mutex);
            steps[event.robot].push_back({std::string(name_of(event.kind)) + " " + event.program + " " + event.text,
                                          1e-9 * static_cast<double>(event.time.ns)});
            if (event.kind == ProgramEvent::Kind::ended || event.kind == ProgramEvent::Kind::failed) ++ended;
          }});
  CyclicThread loop(*engine, {.name = "tick", .period = Nanoseconds(1'000'000), .policy = RealTimePolicy::prefer});
  EXPECT_TRUE(owner.prepare(script, true));
  EXPECT_TRUE(loop.start());
  owner.start();
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  const auto done = [&] {
    const std::scoped_lock lock(mutex);
    return ended >= ends;
  };
  while (!done() && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(done()) << "the programs do not end";
  owner.stop();
  loop.stop();
  return steps;
}

Steps run_off_line(const fs::path& cell_file, const std::string& script, std::size_t& ends) {
  SimulationOptions options;
  options.script = script;
  options.collisions = false;
  const auto result = simulate(load(cell_file), options);
  EXPECT_TRUE(result) << result.error().text();
  Steps steps;
  ends = 0;
  for (const SimulatedEvent& event : result->events) {
    steps[event.robot].push_back({event.event + " " + event.program + " " + event.text, event.time_s});
    if (event.event == "ended" || event.event == "failed") ++ends;
  }
  EXPECT_FALSE(result->failed());
  return steps;
}

std::vector<std::string> words(const std::vector<Step>& steps) {
  std::vector<std::string> out;
  for (const Step& step : steps) out.push_back(step.what);
  return out;
}

double largest_difference(const Steps& a, const Steps& b) {
  double largest = 0;
  for (const auto& [robot, list] : a) {
    const auto other = b.find(robot);
    if (other == b.end() || other->second.size() != list.size()) return 1e9;
    for (std::size_t i = 0; i < list.size(); ++i)
      largest = std::max(largest, std::abs(list[i].time_s - other->second[i].time_s));
  }
  return largest;
}

class SameTimes : public testing::TestWithParam<std::string> {};

TEST_P(SameTimes, InTheGatewayAndOffLine) {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  if (source == nullptr) GTEST_SKIP() << "skipped: CELLMIRROR_SOURCE_DIR is not set";
  const fs::path cell = fs::path(source) / "config/cells/transfer_cell/cell.toml";
  const std::string script = cell.parent_path() / "scripts" / GetParam();
  std::size_t ends = 0;
  const Steps off_line = relative(run_off_line(cell, script, ends));
  ASSERT_GT(ends, 0U);
  double difference = 0;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Steps real = relative(run_in_real_time(cell, script, ends));
    ASSERT_EQ(real.size(), off_line.size());
    for (const auto& [robot, steps] : real) EXPECT_EQ(words(steps), words(off_line.at(robot))) << robot;
    difference = largest_difference(real, off_line);
    if (difference <= kTick + kTolerance) break;
  }
  EXPECT_LE(difference, kTick + kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Scripts, SameTimes, testing::Values("trsys_demo.spt"));

}  // namespace
}  // namespace cellmirror::app
