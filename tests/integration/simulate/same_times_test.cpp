// Robot programs run in the gateway's threads and off line: the same commands in the same order, and the same times
// within a tick of the cell's time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/simulation/simulation.hpp"
#include "tests/integration/simulate/real_time_owner.hpp"
#include "tests/integration/simulate/stepped_owner.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

constexpr double kTick = 1e-3;      // s
constexpr double kRounding = 2e-5;  // s

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

template <typename Owner>
Steps run_in_threads(const fs::path& cell, const std::string& script, std::size_t ends) {
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
  Owner owner(load_cell_for_test(cell), [](std::int64_t, const ScriptReply&) {}, hear);
  owner.start(script);
  EXPECT_TRUE(await(done)) << "the programs do not end";
  owner.stop();
  return recording.steps();
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

// What took place more than a tick earlier or later. When a move was given ahead says nothing.
std::string differences(const Steps& in_threads, const Steps& off_line) {
  std::string out;
  for (const auto& [key, list] : off_line) {
    if (key.second == "command") continue;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double time = in_threads.at(key)[i].time_s;
      if (std::abs(time - list[i].time_s) <= kTick + kRounding) continue;
      out += fmt::format("{} {} {}: {:.6f} s off line, {:.6f} s in the gateway\n", key.first, key.second, list[i].what,
                         list[i].time_s, time);
    }
  }
  return out;
}

fs::path transfer_cell() { return source_folder() / "config/cells/transfer_cell/cell.toml"; }
std::string script_of_cell(const std::string& name) { return transfer_cell().parent_path() / "scripts" / name; }

class SameTimes : public testing::TestWithParam<std::string> {};

TEST_P(SameTimes, InTheGatewayAndOffLine) {
  if (source_folder().empty()) GTEST_SKIP() << "skipped: CELLMIRROR_SOURCE_DIR is not set";
  const std::string script = script_of_cell(GetParam());
  const Recording off_line = run_off_line(transfer_cell(), script);
  ASSERT_GT(off_line.ends(), 0U);
  const Steps in_threads = run_in_threads<SteppedOwner>(transfer_cell(), script, off_line.ends());
  ASSERT_EQ(words(in_threads), words(off_line.steps()));
  EXPECT_EQ(differences(in_threads, off_line.steps()), "");
}

// The manual's own script, and its examples of TF_RUN: two arms that hand over parts, and three programs of a crane
// behind each other.
INSTANTIATE_TEST_SUITE_P(Scripts, SameTimes, testing::Values("trsys_demo.spt", "tf_run.spt"));

// Here the machine may stand still for a moment, and what comes then comes later: when is compared above.
TEST(SameCommands, BesideRealTimeAndOffLine) {
  if (source_folder().empty()) GTEST_SKIP() << "skipped: CELLMIRROR_SOURCE_DIR is not set";
  const std::string script = script_of_cell("trsys_demo.spt");
  const Recording off_line = run_off_line(transfer_cell(), script);
  ASSERT_GT(off_line.ends(), 0U);
  EXPECT_EQ(words(run_in_threads<RealTimeOwner>(transfer_cell(), script, off_line.ends())), words(off_line.steps()));
}

}  // namespace
}  // namespace cellmirror::app
