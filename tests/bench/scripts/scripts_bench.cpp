// Goals: 1,000,000 commands a second parsed and checked on one core, 100,000 a second executed from a file.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "rt_core/base/home.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/runner/script_runner.hpp"
#include "tests/golden/scripts/fake_names.hpp"
#include "tests/golden/scripts/quiet_host.hpp"

namespace cellmirror::script {
namespace {

// A mixture as a cell sees it: placements and joint positions by measurement, then structure and parameters.
std::string mixed_script(std::size_t commands) {
  constexpr std::string_view kMixture[] = {
      "POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271;\n",
      "SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 PLACEMENT -88.5 16.32851 -180.0 -11920.0 2517.3 912.7;\n",
      "CONNECT Testlab_1.FL_Klein_02.Flansch_Typ1 TO Mantec_1.HAND;\n",
      "ROBACT PUMA_762;\n",
      "rob_jnt_max_vel 1.919862 1.483553 5.235988 3.14159 4.014257 3.926991;\n",
      "rob_cart_vel_scal 0.3;\n",
      "FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND Tool1_WFRM;\n",
      "SET_CAMPAR CAMERA_5 4.85 15.71;\n",
      "# a comment line\n",
      "DRAW_SCENE;\n",
  };
  constexpr std::size_t kCommandsOfMixture = std::size(kMixture) - 1;
  std::string text;
  for (std::size_t n = 0; n < commands; n += kCommandsOfMixture) {
    for (const std::string_view line : kMixture) text += line;
  }
  return text;
}

std::size_t read_all(std::string_view text, const NameDirectory* names, benchmark::State& state) {
  CommandReader reader(text, "bench", TextKind::file);
  ParsedCommand command;
  Diagnostics findings;
  std::size_t commands = 0;
  for (;;) {
    const CommandReader::Step step = reader.next(names, command, findings);
    if (step == CommandReader::Step::end) return commands;
    if (step != CommandReader::Step::command) state.SkipWithError(findings.text().c_str());
    benchmark::DoNotOptimize(command);
    ++commands;
  }
}

void BM_ParseAndCheckMixture(benchmark::State& state) {
  cellmirror::testing::FakeNames names;
  names.active = "PUMA_762";
  const std::string text = mixed_script(9000);
  std::size_t commands = 0;
  for (auto _ : state) commands += read_all(text, &names, state);
  state.SetItemsProcessed(static_cast<std::int64_t>(commands));
}
BENCHMARK(BM_ParseAndCheckMixture)->Unit(benchmark::kMillisecond);

void BM_ParseAndCheckOne(benchmark::State& state, std::string_view one) {
  cellmirror::testing::FakeNames names;
  names.active = "PUMA_762";
  std::string text;
  for (int n = 0; n < 1000; ++n) text += one;
  std::size_t commands = 0;
  for (auto _ : state) commands += read_all(text, &names, state);
  state.SetItemsProcessed(static_cast<std::int64_t>(commands));
}
BENCHMARK_CAPTURE(BM_ParseAndCheckOne, draw_scene, "DRAW_SCENE;\n");
BENCHMARK_CAPTURE(BM_ParseAndCheckOne, robact, "ROBACT PUMA_762;\n");
BENCHMARK_CAPTURE(BM_ParseAndCheckOne, joints, "POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271;\n");
BENCHMARK_CAPTURE(BM_ParseAndCheckOne, placement,
                  "SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 PLACEMENT -88.5 16.32851 -180.0 -11920.0 2517.3 912.7;\n");

void BM_SyntaxOnly(benchmark::State& state) {
  const std::string text = mixed_script(9000);
  std::size_t commands = 0;
  for (auto _ : state) commands += read_all(text, nullptr, state);
  state.SetItemsProcessed(static_cast<std::int64_t>(commands));
}
BENCHMARK(BM_SyntaxOnly)->Unit(benchmark::kMillisecond);

// Loading (and so checking the whole) of the file included.
void BM_ExecuteFile(benchmark::State& state) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("cellmirror_scripts_bench_" + std::to_string(getpid()));
  fs::create_directories(folder / "scripts");
  std::ofstream(folder / "scripts" / "mixed.spt") << mixed_script(static_cast<std::size_t>(state.range(0)));
  {
    const auto home = KismetHome::open(folder);
    cellmirror::testing::QuietHost gateway;
    const SystemClock clock;
    std::size_t commands = 0;
    for (auto _ : state) {
      ScriptRunner runner(gateway.host(), *home, clock);
      if (!runner.start_file("mixed")) state.SkipWithError("the script was refused");
      while (const std::size_t executed = runner.step(1000)) commands += executed;
      if (runner.counters().file.refused != 0) state.SkipWithError(runner.last_errors().front().c_str());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(commands));
  }
  fs::remove_all(folder);
}
BENCHMARK(BM_ExecuteFile)->Arg(1000)->Arg(150000)->Unit(benchmark::kMillisecond);

void BM_ExecuteMessage(benchmark::State& state) {
  const auto home = KismetHome::open(std::filesystem::temp_directory_path());
  cellmirror::testing::QuietHost gateway;
  const SystemClock clock;
  ScriptRunner runner(gateway.host(), *home, clock);
  for (auto _ : state) {
    auto answer = runner.execute_message("POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271");
    benchmark::DoNotOptimize(answer);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(BM_ExecuteMessage);

}  // namespace
}  // namespace cellmirror::script

BENCHMARK_MAIN();
