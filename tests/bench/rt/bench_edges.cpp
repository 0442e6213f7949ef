// What the other parts cost the tick: Latest, Ring, LatencyHistogram, AllocationGuard.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <memory>

#include "rt_core/rt/allocation_guard.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "rt_core/rt/latest.hpp"
#include "rt_core/rt/ring.hpp"

namespace cellmirror {
namespace {

struct Value {
  std::array<std::uint64_t, 52> words{};
};

void latest_write_and_read(benchmark::State& state) {
  const auto sut = std::make_unique<Latest<Value>>();
  const Value value{};
  for (auto _ : state) {
    sut->write(value);
    benchmark::DoNotOptimize(sut->read().value.words[0]);
  }
}
BENCHMARK(latest_write_and_read)->Name("latest/416_bytes/write_and_read");

void latest_read_nothing_new(benchmark::State& state) {
  const auto sut = std::make_unique<Latest<Value>>();
  for (auto _ : state) {
    benchmark::DoNotOptimize(sut->read().is_new);
  }
}
BENCHMARK(latest_read_nothing_new)->Name("latest/416_bytes/read_nothing_new");

void ring_push(benchmark::State& state) {
  const auto sut = std::make_unique<Ring<Value, 1024>>();
  const Value value{};
  for (auto _ : state) {
    sut->push(value);
  }
}
BENCHMARK(ring_push)->Name("ring/416_bytes/push");

void histogram_record(benchmark::State& state) {
  const auto sut = std::make_unique<LatencyHistogram>();
  std::int64_t ns = 1;
  for (auto _ : state) {
    sut->record(Nanoseconds{ns});
    ns = (ns * 7) & 0xFFFFFF;
  }
}
BENCHMARK(histogram_record)->Name("histogram/record");

void histogram_reset_and_record(benchmark::State& state) {
  const auto sut = std::make_unique<LatencyHistogram>();
  for (auto _ : state) {
    sut->request_reset();
    sut->record(Nanoseconds{5});
  }
}
BENCHMARK(histogram_reset_and_record)->Name("histogram/record_after_reset_request");

void guard(benchmark::State& state) {
  for (auto _ : state) {
    const AllocationGuard sut;
    benchmark::DoNotOptimize(sut.allocations());
  }
}
BENCHMARK(guard)->Name("allocation_guard");

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
