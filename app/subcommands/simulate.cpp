// cellmirror simulate: a script and its robot programs off line, faster than real time.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/console/load_progress.hpp"
#include "app/simulation/simulation.hpp"
#include "app/simulation/simulation_report.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/tissue/body/element_kernel.hpp"

namespace cellmirror::app {

namespace {

struct SimulateOptions {
  std::string cell;
  SimulationOptions simulation;
  bool no_collisions = false;
  std::string plot;
  std::string simd;
  bool json = false;
};

constexpr double kLongest = 1e6;         // s of simulated time
constexpr double kLongestPeriod = 3600;  // s
constexpr std::size_t kLongestNote = 400;

std::optional<LoadedCell> load(const std::string& file) {
  Diagnostics diagnostics;
  ProgressLine line("files loaded");
  auto cell = load_cell(file, diagnostics, load_progress(line));
  std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
  return cell;
}

// Where standard error is no terminal: a line now and then shows that a long simulation goes on.
class SlowNews {
 public:
  explicit SlowNews(double longest_s) : longest_s_(longest_s) {}

  void update(double now_s) {
    constexpr std::chrono::seconds kEvery{10};
    const auto now = std::chrono::steady_clock::now();
    if (!needed_ || now - last_ < kEvery) return;
    last_ = now;
    fmt::print(stderr, "cellmirror: {:.0f} s simulated, {:g} s at most (--for)\n", now_s, longest_s_);
  }

 private:
  double longest_s_;
  bool needed_ = isatty(STDERR_FILENO) != 1;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// What limits the trust in the results, in one sentence.
std::string failure(const SimulationResult& result) {
  std::size_t failed = 0;
  for (const SimulatedProgram& run : result.programs) failed += run.end == "failed" ? 1 : 0;
  return fmt::format("the simulation found faults: {} refused, {} failed, {}; it ended: {}{}",
                     number_of(result.refusals.size() + result.more_refusals, "command"), number_of(failed, "program"),
                     number_of(result.deadlocks.size(), "deadlock"), end_word(result.end),
                     result.end_note.empty() ? "" : ": " + printable(result.end_note, kLongestNote));
}

int print(const SimulateOptions& options, const SimulationResult& result) {
  const std::string text = options.json ? simulation_json(result) : simulation_text(result);
  std::fputs(text.c_str(), stdout);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    return refuse(std::string("standard output cannot be written: ") + std::strerror(errno));
  if (!options.plot.empty()) {
    if (auto drawn = plot::write_png(simulation_figure(result), options.plot); !drawn)
      return refuse(drawn.error().text());
  }
  return result.failed() ? refuse(failure(result)) : kExitDone;
}

int run(const SimulateOptions& options) {
  if (!options.simd.empty() && !tissue::force_simd_target(options.simd))
    return refuse(fmt::format("this processor has no instruction set {}; its best one is {}",
                              printable(options.simd, kLongestNote), tissue::simd_target()));
  auto cell = load(options.cell);
  if (!cell) return kExitRefused;
  SimulationOptions simulation = options.simulation;
  simulation.collisions = !options.no_collisions;
  set_log_level(LogLevel::error);  // messages and refusals are in the result, with their times
  Result<SimulationResult> result;
  {
    ProgressLine line("simulated seconds at most");
    SlowNews news(simulation.longest_s);
    result = simulate(std::move(*cell), simulation, [&](double now_s) {
      news.update(now_s);
      line.update(static_cast<std::uint64_t>(now_s), static_cast<std::uint64_t>(std::ceil(simulation.longest_s)));
    });
  }
  return result ? print(options, *result) : refuse(result.error().text());
}

}  // namespace

void add_simulate(cli::Command program, Action& action) {
  auto options = std::make_shared<SimulateOptions>();
  cli::Command sub =
      program.subcommand("simulate", "Run a script and its robot programs off line, faster than real time");
  sub.option("--cell", options->cell, "the cell file or its folder").required();
  sub.option("--script", options->simulation.script, "the SCRIPT file: any path, or a name in the scripts/ of the cell")
      .required();
  auto off = sub.flag("--no-collisions", options->no_collisions, "do not test for collisions");
  sub.option("--collision-period", options->simulation.collision_period_s,
             "simulated seconds from one collision test to the next")
      .between(1e-4, kLongestPeriod)
      .show_default()
      .excludes(off);
  sub.option("--for", options->simulation.longest_s, "end it after so many simulated seconds")
      .between(1e-3, kLongest)
      .show_default();
  sub.option("--still", options->simulation.still_s, "end it when nothing has happened for so many simulated seconds")
      .between(1e-3, kLongest)
      .show_default();
  sub.option("--plot", options->plot, "draw programs, joints and distances over time: a PNG file");
  sub.option("--simd", options->simd,
             "compute tissue with this instruction set (AVX2, SSE4, ...), so that results are the same on another "
             "machine to the bit");
  sub.flag("--json", options->json, "one JSON document (docs/simulate.md)");
  sub.footer(
      "Collisions and limits are results, not failures. The exit status is 1 where a command was refused, a program "
      "failed,\n"
      "programs wait for each other, or the script did not come to its end.\n"
      "Example: cellmirror simulate --cell config/cells/transfer_cell/cell.toml --script trs_demo.spt --plot demo.png");
  sub.when_named([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace cellmirror::app
