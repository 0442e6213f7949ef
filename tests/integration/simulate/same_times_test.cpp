// Robot programs run beside real time, as in the gateway, and off line: the same commands in the same order, and the
// same times within a tick.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/simulation/simulation.hpp"
#include "tests/integration/simulate/real_time_owner.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

constexpr double kTick = 1e-3;      // s
constexpr double kRounding = 2e-5;  // s
constexpr double kMostOutliers = 0.1;
constexpr std::size_t kRuns = 5;
constexpr std::chrono::milliseconds kApart{300};

// What a robot's programs did of one kind ("command", "move_ended", ...), in its order. Kinds apart: when something is
// noticed decides in which order things of different kinds are told.
struct Step {
  std::string what;
  double time_s = 0;  // after the start of the robot's first program
};
using Key = std::pair<std::string, std::string>;  // robot, kind
using Steps = std::map<Key, std::vector<Step>>;

class Recording {
 public:
  void add(const std::string& robot, const std::string& kind, std::string what, double time_s) {
    const double begin = begins_.try_emplace(robot, time_s).first->second;
    steps_[{robot, kind}].push_back({std::move(what), time_s - begin});
    if (kind == "ended" || kind == "failed") ++ends_;
  }
  [[nodiscard]] std::size_t ends() const { return ends_; }
  [[nodiscard]] const Steps& steps() const { return steps_; }

 private:
  std::map<std::string, double> begins_;
  Steps steps_;
  std::size_t ends_ = 0;
};

Steps run_in_real_time(const fs::path& cell, const std::string& script, std::size_t ends) {
  std::mutex mutex;
  Recording recording;
  const auto hear = [&](const program::ProgramEvent& event) {
    const std::scoped_lock lock(mutex);
    recording.add(event.robot, std::string(name_of(event.kind)), event.program + " " + event.text,
                  1e-9 * static_cast<double>(event.time.ns));
  };
  const auto done = [&] {
    const std::scoped_lock lock(mutex);
    return recording.ends() >= ends;
  };
  RealTimeOwner owner(load_cell_for_test(cell), [](std::int64_t, const ScriptReply&) {}, hear);
  owner.start(script);
  EXPECT_TRUE(await(done)) << "the programs do not end";
  owner.stop();
  return recording.steps();
}

// All beside each other, each begun a little after the one before: where the machine stands still for a moment, they
// are at different places.
std::vector<Steps> runs_in_real_time(const fs::path& cell, const std::string& script, std::size_t ends) {
  std::vector<std::future<Steps>> running;
  for (std::size_t i = 0; i < kRuns; ++i) {
    running.push_back(std::async(std::launch::async, [&] { return run_in_real_time(cell, script, ends); }));
    std::this_thread::sleep_for(kApart);
  }
  std::vector<Steps> out;
  for (std::future<Steps>& run : running) out.push_back(run.get());
  return out;
}

Recording run_off_line(const fs::path& cell, const std::string& script) {
  SimulationOptions options;
  options.script = script;
  options.collisions = false;
  const auto result = simulate(load_cell_for_test(cell), options);
  Recording recording;
  EXPECT_TRUE(result) << result.error().text();
  if (!result) return recording;
  EXPECT_FALSE(result->failed());
  for (const SimulatedEvent& event : result->events)
    recording.add(event.robot, event.event, event.program + " " + event.text, event.time_s);
  return recording;
}

std::map<Key, std::vector<std::string>> words(const Steps& steps) {
  std::map<Key, std::vector<std::string>> out;
  for (const auto& [key, list] : steps) {
    for (const Step& step : list) out[key].push_back(step.what);
  }
  return out;
}

// Programs begin and end at exact instants, however late that is noticed. Of several moves that have ended when
// somebody looks, only the last one's instant is known, and two commands of a script that start programs of two robots
// are executed at two instants: on a machine that stands still for a moment some are off. So the median of the runs is
// compared, and a few of the moves may be further off. When a move was given ahead says nothing.
struct Differences {
  double of_programs = 0;  // s, the largest
  std::vector<double> of_steps;
  std::string text;

  [[nodiscard]] bool within_a_tick() const {
    const auto far = [](double difference) { return difference > kTick + kRounding; };
    const auto outliers = static_cast<double>(std::ranges::count_if(of_steps, far));
    return !far(of_programs) && outliers <= kMostOutliers * static_cast<double>(of_steps.size());
  }
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Differences differences(const std::vector<Steps>& real, const Steps& off_line) {
  Differences out;
  for (const auto& [key, list] : off_line) {
    if (key.second == "command") continue;
    const bool of_program = key.second == "started" || key.second == "ended";
    for (std::size_t i = 0; i < list.size(); ++i) {
      std::vector<double> times;
      for (const Steps& run : real) times.push_back(run.at(key)[i].time_s);
      const double time = median(std::move(times));
      const double difference = std::abs(time - list[i].time_s);
      if (of_program) out.of_programs = std::max(out.of_programs, difference);
      out.of_steps.push_back(difference);
      if (difference <= kTick + kRounding) continue;
      out.text += fmt::format("{} {} {}: {:.6f} s off line, {:.6f} s in the gateway\n", key.first, key.second,
                              list[i].what, list[i].time_s, time);
    }
  }
  return out;
}

class SameTimes : public testing::TestWithParam<std::string> {};

TEST_P(SameTimes, InTheGatewayAndOffLine) {
  if (source_folder().empty()) GTEST_SKIP() << "skipped: CELLMIRROR_SOURCE_DIR is not set";
  const fs::path cell = source_folder() / "config/cells/transfer_cell/cell.toml";
  const std::string script = cell.parent_path() / "scripts" / GetParam();
  const Recording off_line = run_off_line(cell, script);
  ASSERT_GT(off_line.ends(), 0U);
  const std::vector<Steps> real = runs_in_real_time(cell, script, off_line.ends());
  for (const Steps& run : real) ASSERT_EQ(words(run), words(off_line.steps()));
  const Differences difference = differences(real, off_line.steps());
  EXPECT_TRUE(difference.within_a_tick()) << difference.text;
}

// The manual's own script, and its examples of TF_RUN: two arms that hand over parts, and three programs of a crane
// behind each other.
INSTANTIATE_TEST_SUITE_P(Scripts, SameTimes, testing::Values("trsys_demo.spt", "tf_run.spt"));

}  // namespace
}  // namespace cellmirror::app
