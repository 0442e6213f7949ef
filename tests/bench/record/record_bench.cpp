// How fast recordings are written and read: messages of 100 bytes a second, bytes a second of messages of 10 KiB,
// beside a bare write(2) of the same bytes in the same run. In memory (/dev/shm), and beside it in
// $CELLMIRROR_BENCH_FOLDER.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include "ipc/record/reader.hpp"
#include "ipc/record/writer.hpp"
#include "rt_core/base/descriptor.hpp"

namespace {

using namespace cellmirror;

constexpr std::size_t kSmall = 100;
constexpr std::size_t kLarge = 10'240;
constexpr std::size_t kFileBytes = std::size_t{64} << 20;  // then another file is begun

std::filesystem::path folder() {
  const char* named = std::getenv("CELLMIRROR_BENCH_FOLDER");
  return named != nullptr ? named : "/dev/shm";
}

std::filesystem::path file_name() { return folder() / ("record_bench_" + std::to_string(::getpid()) + ".mcap"); }

// Values that change a little from message to message, as joints do: half of the bytes are noise.
mcap::Bytes content(std::size_t size) {
  std::mt19937 random(1);
  mcap::Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = i % 8 < 4 ? static_cast<std::byte>(random()) : std::byte{0x3F};
  return out;
}

void write_messages(benchmark::State& state, std::size_t size, mcap::Compression compression) {
  const mcap::Bytes data = content(size);
  std::uint64_t messages = 0;
  while (state.KeepRunning()) {
    state.PauseTiming();
    std::filesystem::remove(file_name());
    auto sink = mcap::FileSink::create(file_name());
    if (!sink) return state.SkipWithError(sink.error().what.c_str());
    mcap::Writer writer(**sink, {.compression = compression});
    state.ResumeTiming();
    bool good = writer.begin().has_value() && writer.put(mcap::Channel{1, 0, "/a", "cdr"}).has_value();
    for (std::size_t written = 0; written < kFileBytes; written += size) {
      ++messages;
      good = good && writer.put(mcap::Message{1, static_cast<std::uint32_t>(messages), messages, messages, data});
    }
    good = good && writer.finish();
    if (!good) return state.SkipWithError("a write failed");
    benchmark::DoNotOptimize(good);
  }
  std::filesystem::remove(file_name());
  state.SetItemsProcessed(static_cast<std::int64_t>(messages));
  state.SetBytesProcessed(static_cast<std::int64_t>(messages * size));
}

void small_messages(benchmark::State& state) {
  write_messages(state, kSmall, static_cast<mcap::Compression>(state.range(0)));
}
void large_messages(benchmark::State& state) {
  write_messages(state, kLarge, static_cast<mcap::Compression>(state.range(0)));
}

// The same bytes in pieces of a chunk's size.
void bare_write(benchmark::State& state) {
  const mcap::Bytes data = content(std::size_t{1} << 20);
  std::uint64_t bytes = 0;
  while (state.KeepRunning()) {
    state.PauseTiming();
    std::filesystem::remove(file_name());
    const Descriptor file(::open(file_name().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    state.ResumeTiming();
    for (std::size_t written = 0; written < kFileBytes; written += data.size()) {
      if (::write(file.get(), data.data(), data.size()) != static_cast<ssize_t>(data.size()))
        return state.SkipWithError("a write failed");
      bytes += data.size();
    }
  }
  std::filesystem::remove(file_name());
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

// Ten messages from the middle of a file of 1 GB.
void seek(benchmark::State& state) {
  std::filesystem::remove(file_name());
  const mcap::Bytes data = content(kLarge);
  constexpr std::uint64_t kMessages = 100'000;
  {
    auto sink = mcap::FileSink::create(file_name());
    if (!sink) return state.SkipWithError(sink.error().what.c_str());
    mcap::Writer writer(**sink, {.compression = mcap::Compression::none});
    bool good = writer.begin().has_value() && writer.put(mcap::Channel{1, 0, "/a", "cdr"}).has_value();
    for (std::uint64_t i = 0; i < kMessages; ++i) good = good && writer.put(mcap::Message{1, 0, i, i, data});
    if (!good || !writer.finish()) return state.SkipWithError("a write failed");
  }
  while (state.KeepRunning()) {
    const auto source = mcap::FileSource::open(file_name());
    auto reader = mcap::Reader::open(**source);
    int found = 0;
    const auto read =
        reader->read({.topics = {}, .from = kMessages / 2, .to = kMessages / 2 + 9}, [&](const auto&, const auto&) {
          ++found;
          return true;
        });
    if (!read || found != 10) return state.SkipWithError("not found");
  }
  std::filesystem::remove(file_name());
}

BENCHMARK(bare_write)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(small_messages)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(large_messages)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(seek)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
