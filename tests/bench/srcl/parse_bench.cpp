// Lines of SRCL read in a second. At least 500,000 are asked for, whatever the length of the program.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

#include "scripts/programs/srcl/srcl.hpp"

namespace {

using namespace cellmirror;

// Moves, settings, computations and blocks as a real program has them.
std::string program_of(std::int64_t lines) {
  std::string text = "PROGRAMM LANG\nGANZ I\nREAL X\nLAGE P\n";
  for (std::int64_t i = 0; i < lines / 10; ++i) {
    text += fmt::format("V_BAHN {}\n", 100 + i % 500);
    text += fmt::format("LIN LAGE({}.5, {}, 312.25, 180, -12.5, 90) UEBER\n", i % 700, i % 300);
    text += fmt::format("PTP STELLUNG({}, -30.5, 12, 100, 0, -45.25)\n", i % 90);
    text += fmt::format("M{}: I = I + 1\n", i);
    text += "WENN I > 100 UND EINGANG(3) DANN ; full\n";
    text += "  X = SIN(X) * 2 + P.Z\n";
    text += "ENDE_WENN\n";
    text += "LIN P * LAGE(0, 0, -50)\n";
    text += "AUSGANG(4) = EIN\n";
    text += "; a comment of one line\n";
  }
  return text;
}

void read_program(benchmark::State& state) {
  const std::string text = program_of(state.range(0));
  for (auto _ : state) {
    Diagnostics findings;
    const auto program = program::srcl_language().parse(text, {"long.src", {}}, findings);
    if (!program) state.SkipWithError("the program has faults");
    benchmark::DoNotOptimize(program);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(read_program)
    ->ArgName("lines")
    ->Arg(1'000)
    ->Arg(10'000)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
