// Every SCRIPT file of scripts/ against the committed trace of the moves that the tick would get, on the transfer cell:
// real parser, handlers, inverse kinematics and planner, no tick. CELLMIRROR_UPDATE_GOLDEN=1 writes the traces anew:
// read the difference before committing it. In files whose name begins with "held_" no move comes to its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/display/display_service.hpp"
#include "app/owner/fleet.hpp"
#include "app/owner/hosts.hpp"
#include "app/owner/motion/coupling_service.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/programs/program_motion.hpp"
#include "app/owner/programs/program_service.hpp"
#include "app/owner/sensing.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "scripts/runner/script_runner.hpp"
#include "tests/golden/motion/recording_port.hpp"
#include "tests/golden/scripts/quiet_host.hpp"

namespace cellmirror {
namespace {

namespace fs = std::filesystem;

fs::path source_folder() {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return source == nullptr ? "." : source;
}
fs::path golden_folder() { return source_folder() / "tests" / "golden" / "motion"; }

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> cases() {
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(golden_folder() / "scripts", error)) {
    if (entry.path().extension() == ".spt") all.push_back(entry.path().stem().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

// The gateway's own hosts on the transfer cell; the tick is there but does not run.
class Stage {
 public:
  Stage(LoadedCell loaded, const KismetHome& home)
      : cell_(std::move(loaded.cell)),
        fleet_(cell_, engine_, {}, clock_, 0),
        port(fleet_, cell_),
        names_(cell_),
        home_(home),
        display_({cell_, names_, home_, clock_, [this] { return port.positions(); }, {}, {}, {}}, {}),
        motion_(
            cell_, names_, [this] { return display_.screen_axes(); }, port, clock_),
        couplings_(cell_, fleet_, motion_),
        program_motion_(cell_, motion_, port, clock_),
        programs_({cell_, home_, fleet_, motion_, display_, program_motion_, clock_}),
        volumes_(cell_, {}),
        world_({cell_, fleet_, motion_, programs_, volumes_, [] {}}),
        robots_(cell_, fleet_, motion_, couplings_, programs_, names_),
        sensing_(cell_, {}),
        diagnosis_([](std::string_view) { return Result<void>(); }, [](RecordAction) { return Result<void>(); }) {
    EXPECT_TRUE(fleet_.follow_cell());
  }

  std::string run(const std::string& name) {
    std::string end = "still waiting\n";
    const auto run_ended = [&](const script::RunReport& report) {
      end = fmt::format("done {}, refused {}\n{}", report.counters.done, report.counters.refused,
                        report.diagnostics.text());
    };
    script::ScriptRunner runner(
        {names_, world_, robots_, motion_, programs_, display_, sensing_, quiet_, quiet_, volumes_, diagnosis_}, home_,
        clock_, {.run_ended = run_ended});
    Diagnostics findings;
    if (!runner.start_file(name, &findings)) return "nothing of it ran\n" + findings.text();
    do {
      motion_.follow();
    } while (runner.step(1000) != 0);
    if (!runner.idle()) {
      for (const std::string& error : runner.last_errors()) end += error.substr(error.find(' ') + 1) + "\n";
    }
    return port.trace + end;
  }

 private:
  ManualClock clock_;
  Cell cell_;
  Watchdog watchdog_{std::chrono::seconds(1), {}};
  engine::Engine engine_{watchdog_};
  app::Fleet fleet_;

 public:
  cellmirror::testing::RecordingPort port;

 private:
  app::CellNames names_;
  const KismetHome& home_;
  app::DisplayService display_;
  app::MotionService motion_;
  app::CouplingService couplings_;
  app::CellProgramMotion program_motion_;
  app::ProgramService programs_;
  app::VolumeService volumes_;
  app::CellWorld world_;
  app::CellRobots robots_;
  app::CellSensing sensing_;
  cellmirror::testing::QuietHost quiet_;  // hands and feet: no motion here
  app::CellDiagnosis diagnosis_;
};

// How near the search comes to a pose out of reach depends on the time that it gets.
std::string without_nearest(std::string text) {
  constexpr std::string_view kBegin = "the nearest that was found is ";
  for (std::size_t at = text.find(kBegin); at != std::string::npos; at = text.find(kBegin, at + kBegin.size())) {
    const std::size_t begin = at + kBegin.size();
    text.replace(begin, text.find('\n', begin) - begin, "...");
  }
  return text;
}

class GoldenMotion : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenMotion, GivesTheExpectedMoves) {
  set_log_level(LogLevel::error);
  Diagnostics diagnostics;
  auto loaded = load_cell(source_folder() / "config" / "cells" / "transfer_cell" / "cell.toml", diagnostics);
  ASSERT_TRUE(loaded) << diagnostics.text();
  const auto home = KismetHome::open(golden_folder());
  ASSERT_TRUE(home) << home.error().text();
  const auto stage = std::make_unique<Stage>(std::move(*loaded), *home);  // the queues of the tick are large
  stage->port.held = GetParam().starts_with("held_");
  const std::string trace = without_nearest(stage->run(GetParam()));
  const fs::path expected = golden_folder() / "expected" / (GetParam() + ".txt");
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) std::ofstream(expected, std::ios::binary) << trace;
  EXPECT_EQ(trace, content(expected)) << expected;
}

INSTANTIATE_TEST_SUITE_P(Scripts, GoldenMotion, ::testing::ValuesIn(cases()),
                         [](const auto& param_info) { return param_info.param; });

}  // namespace
}  // namespace cellmirror
