// Throughput of the CAN codecs and sessions, and frames over the udp channel of the loopback interface into samples.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/channel/candump_line.hpp"
#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/channel/udp_datagram.hpp"
#include "drivers/can/cia402/session.hpp"
#include "drivers/can/dbc/session.hpp"
#include "drivers/can/stream/streams.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

CanFrame tpdo(std::uint8_t node, std::int32_t position) {
  CanFrame frame = make_frame(0x180U + node, {0x37, 0x02, 0, 0, 0, 0});
  put_le(std::span(frame.data).subspan(2), static_cast<std::uint32_t>(position), 4);
  return frame;
}

Cia402StreamConfig seven_joints() {
  Cia402StreamConfig config;
  config.start_nodes = false;
  config.heartbeat_timeout = 0ns;
  for (std::uint8_t id = 1; id <= 7; ++id) {
    Cia402NodeConfig node;
    node.node_id = id;
    node.joint = id - 1U;
    node.joint_name = "J";
    config.nodes.push_back(node);
  }
  return config;
}

void BM_DecodeUdpDatagram(benchmark::State& state) {
  const UdpDatagram datagram = encode_udp_datagram(tpdo(3, 123456), 1.0);
  for (auto _ : state) benchmark::DoNotOptimize(decode_udp_datagram(datagram.view()));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_DecodeUdpDatagram);

void BM_EncodeUdpDatagram(benchmark::State& state) {
  const CanFrame frame = tpdo(3, 123456);
  for (auto _ : state) benchmark::DoNotOptimize(encode_udp_datagram(frame, 1.0));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_EncodeUdpDatagram);

void BM_ParseCandumpLine(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(parse_candump_line("(1436509052.249713) vcan0 183#370278563412"));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_ParseCandumpLine);

struct NoOutput : Cia402SessionOutput, DbcSessionOutput {
  std::uint64_t samples = 0;
  bool send(const CanFrame&) override { return true; }
  void sample(const JointSample& sample) override {
    benchmark::DoNotOptimize(sample.position[0]);
    ++samples;
  }
  void event(const Cia402Event&) override {}
  void rejected(const std::string&) override {}
  void outside(const std::string&) override {}
};

void BM_TpdoToSample(benchmark::State& state) {
  Diagnostics diagnostics;
  NoOutput output;
  Cia402Session session(*plan_cia402(seven_joints(), diagnostics), output);
  Timestamp now{1};
  session.start(now);
  std::uint8_t node = 1;
  for (auto _ : state) {
    now = now + 1us;
    session.receive(tpdo(node, 5), now);
    node = static_cast<std::uint8_t>(node % 7 + 1);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_TpdoToSample);

void BM_DbcFrameToSample(benchmark::State& state) {
  constexpr std::string_view kText =
      "BO_ 256 Axis: 8 R\n SG_ P : 0|32@1- (0.001,0) [0|0] \"deg\" M\n SG_ V : 39|16@0- (0.1,0) [0|0] \"\" M\n";
  Diagnostics diagnostics;
  DbcStreamConfig config;
  config.signals = {{"Axis", "P", 0, "J", JointQuantity::position, 1.0, 0.0},
                    {"Axis", "V", 0, "J", JointQuantity::velocity, 1.0, 0.0}};
  NoOutput output;
  DbcSession session(*plan_dbc(config, parse_dbc(kText, "bench.dbc", diagnostics), diagnostics), output);
  const CanFrame frame = make_frame(256, {1, 2, 3, 4, 5, 6, 7, 8});
  for (auto _ : state) session.receive(frame, {1});
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_DbcFrameToSample);

// Latencies from just before the send to the push, by a stamp in the position.
struct LatencySink : JointSampleSink {
  explicit LatencySink(const std::vector<std::int64_t>& sent_ns) : sent(&sent_ns), latency_ns(sent_ns.size(), -1) {}
  bool push(const JointSample& sample) noexcept override {
    for (std::size_t joint = 0; joint < 7; ++joint) {
      if ((sample.present >> joint & 1U) == 0) continue;
      const auto number = static_cast<std::size_t>(sample.position[joint]);
      if (number < latency_ns.size()) latency_ns[number] = clock.now().ns - (*sent)[number];
      ++count;
    }
    return true;
  }
  const std::vector<std::int64_t>* sent;
  std::vector<std::int64_t> latency_ns;
  SystemClock clock;
  std::atomic<std::uint64_t> count{0};
};

double cpu_seconds(int who = RUSAGE_SELF) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

// Frames a second as given, for two seconds (CAN_BENCH_SECONDS), from a sender in this process.
void BM_UdpFramesToSamples(benchmark::State& state) {
  const char* given = std::getenv("CAN_BENCH_SECONDS");
  const int run_s = given != nullptr ? std::clamp(std::atoi(given), 1, 60) : 2;
  const auto rate = static_cast<std::size_t>(state.range(0));
  const std::size_t total = rate * static_cast<std::size_t>(run_s);
  Cia402StreamConfig config = seven_joints();
  config.channel.endpoint = "udp:239.76." + std::to_string(getpid() >> 8 & 0xFF) + "." +
                            std::to_string(getpid() & 0xFF) + ":" + std::to_string(20000 + getpid() % 20000);
  SystemClock clock;
  for (auto _ : state) {
    std::vector<std::int64_t> sent(total, 0);
    LatencySink sink(sent);
    auto stream = make_cia402_stream(config, clock);
    auto sender = open_can_channel(config.channel);
    if (!stream || !sender || !(*stream)->open(sink)) {
      state.SkipWithError("no multicast on the loopback interface");
      return;
    }
    const double cpu_before = cpu_seconds();
    const Timestamp start = clock.now();
    for (std::size_t i = 0; i < total; ++i) {
      // Bursts of 16, as a bus with several nodes brings them.
      if (i % 16 == 0) {
        const Timestamp due =
            start + Nanoseconds(static_cast<std::int64_t>(1e9 * static_cast<double>(i) / static_cast<double>(rate)));
        if (const Nanoseconds early = due - clock.now(); early.count() > 0) std::this_thread::sleep_for(early);
      }
      sent[i] = clock.now().ns;
      (*sender)->send(tpdo(static_cast<std::uint8_t>(i % 7 + 1), static_cast<std::int32_t>(i)));
    }
    for (int i = 0; i < 200 && sink.count < total; ++i) std::this_thread::sleep_for(5ms);
    const double elapsed = seconds(clock.now() - start);
    (*stream)->close();
    std::erase(sink.latency_ns, -1);
    std::sort(sink.latency_ns.begin(), sink.latency_ns.end());
    const auto quantile = [&sink](double q) {
      const auto n = static_cast<double>(sink.latency_ns.size() - 1);
      return 1e-3 * static_cast<double>(sink.latency_ns[static_cast<std::size_t>(q * n)]);
    };
    state.counters["lost"] = static_cast<double>(total - sink.count);
    state.counters["frames_per_s"] = static_cast<double>(sink.count) / elapsed;
    state.counters["p50_us"] = quantile(0.5);
    state.counters["p99_us"] = quantile(0.99);
    state.counters["cpu_cores_both_ends"] = (cpu_seconds() - cpu_before) / elapsed;
  }
}
BENCHMARK(BM_UdpFramesToSamples)->Arg(1000)->Arg(16'000)->Arg(50'000)->Iterations(1)->Unit(benchmark::kMillisecond);

struct CountingSink : JointSampleSink {
  bool push(const JointSample&) noexcept override {
    ++count;
    return true;
  }
  std::atomic<std::uint64_t> count{0};
};

// 32 robots of seven joints at 500 Hz, each on a group of its own: 112,000 frames a second, one TPDO a joint.
void BM_ThirtyTwoRobots(benchmark::State& state) {
  constexpr std::size_t kRobots = 32;
  constexpr auto kPeriod = 2ms;
  const char* given = std::getenv("CAN_BENCH_SECONDS");
  const int run_s = given != nullptr ? std::clamp(std::atoi(given), 1, 60) : 2;
  SystemClock clock;
  for (auto _ : state) {
    std::vector<CountingSink> sinks(kRobots);
    std::vector<std::unique_ptr<JointStream>> streams;
    std::vector<std::unique_ptr<CanChannel>> senders;
    for (std::size_t robot = 0; robot < kRobots; ++robot) {
      Cia402StreamConfig config = seven_joints();
      config.channel.endpoint = "udp:239.77." + std::to_string(getpid() & 0xFF) + "." + std::to_string(robot + 1) +
                                ":" + std::to_string(20000 + getpid() % 20000);
      auto stream = make_cia402_stream(config, clock);
      auto sender = open_can_channel(config.channel);
      if (!stream || !sender || !(*stream)->open(sinks[robot])) {
        state.SkipWithError("no multicast on the loopback interface");
        return;
      }
      streams.push_back(std::move(*stream));
      senders.push_back(std::move(*sender));
    }
    const double cpu_before = cpu_seconds() - cpu_seconds(RUSAGE_THREAD);
    const Timestamp start = clock.now();
    const int cycles = run_s * 500;
    for (int cycle = 0; cycle < cycles; ++cycle) {
      for (auto& sender : senders) {
        for (std::uint8_t node = 1; node <= 7; ++node) sender->send(tpdo(node, cycle));
      }
      const Nanoseconds early = start + (cycle + 1) * Nanoseconds(kPeriod) - clock.now();
      if (early.count() > 0) std::this_thread::sleep_for(early);
    }
    std::this_thread::sleep_for(200ms);
    const double elapsed = seconds(clock.now() - start);
    const double cpu = cpu_seconds() - cpu_seconds(RUSAGE_THREAD) - cpu_before;
    std::uint64_t received = 0;
    for (const CountingSink& sink : sinks) received += sink.count;
    for (auto& stream : streams) stream->close();
    state.counters["lost"] = static_cast<double>(kRobots * 7 * static_cast<std::size_t>(cycles) - received);
    state.counters["frames_per_s"] = static_cast<double>(received) / elapsed;
    state.counters["cpu_cores_receiving"] = cpu / elapsed;
  }
}
BENCHMARK(BM_ThirtyTwoRobots)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cellmirror::can

BENCHMARK_MAIN();
