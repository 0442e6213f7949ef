// How long a CAN frame takes from being sent to being a joint in the published state, over udp on the loopback
// interface, with the real driver and the real loop. Goal: p99 at most one period + 150 us. Beside it, in the same run,
// the raw limit: the same datagrams to a thread that does nothing but take their time.
//   frame_to_snapshot [SECONDS=20]
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/channel/open_channel.hpp"
#include "drivers/can/stream/streams.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/memory_lock.hpp"

using namespace cellmirror;

namespace {

constexpr Nanoseconds kPeriod{1'000'000};
constexpr const char* kEndpoint = "udp:239.74.163.2:43990";

// The number of the frame is the joint's position, exact in a float up to 2^24.
CanFrame numbered(std::uint32_t number) {
  CanFrame frame;
  frame.id = 0x123;
  frame.length = 4;
  std::memcpy(frame.data.data(), &number, sizeof number);
  return frame;
}

struct Setting {
  std::string dbc_file;

  Setting()
      : dbc_file((std::filesystem::temp_directory_path() / ("f2s-" + std::to_string(getpid()) + ".dbc")).string()) {
    std::ofstream(dbc_file) << "BO_ 291 M: 4 X\n SG_ N : 0|32@1+ (1,0) [0|0] \"\" X\n";
  }
  ~Setting() { std::filesystem::remove(dbc_file); }
};

void add_mirrored_robot(engine::Engine& engine) {
  engine.send(engine::AddRobot{
      .slot = 0,
      .robot = engine.lend(std::make_shared<const engine::RobotSetup>(engine::RobotSetup{.joint_count = 1})),
  });
  engine.send(engine::SetMode{.slot = 0, .mode = engine::RobotMode::mirrored});
}

void print(const char* name, std::vector<double> us) {
  if (us.empty()) return;
  std::sort(us.begin(), us.end());
  const auto at = [&us](double p) { return us[static_cast<std::size_t>(p * static_cast<double>(us.size() - 1))]; };
  std::printf("%-28s n %zu  p50 %.0f  p99 %.0f  p99.9 %.0f  max %.0f us\n", name, us.size(), at(0.5), at(0.99),
              at(0.999), us.back());
}

// Latencies of all frames that the flight recorder has seen, by the frames' numbers.
void collect(const engine::Engine& engine, std::map<std::uint32_t, std::int64_t>& published_ns) {
  std::map<std::uint64_t, engine::FlightTick> ticks;
  for (const engine::FlightTick& tick : engine.flight_ticks()) ticks.emplace(tick.tick, tick);
  for (const engine::FlightRobot& robot : engine.flight_robots()) {
    const auto tick = ticks.find(robot.tick);
    const auto next = ticks.find(robot.tick + 1);  // it knows how long the one before took
    if (tick == ticks.end() || next == ticks.end() || robot.event != engine::FlightEvent::sample) continue;
    published_ns.emplace(static_cast<std::uint32_t>(robot.position[0]), tick->second.time.ns + next->second.compute_ns);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds_wanted = argc > 1 ? std::atof(argv[1]) : 20;
  const Setting setting;
  const SystemClock clock;
  static_cast<void>(lock_memory(RealTimePolicy::prefer));
  Watchdog watchdog(std::chrono::milliseconds(100), {});
  const auto engine = std::make_unique<engine::Engine>(watchdog);
  CyclicThread loop(*engine, {.name = "tick", .period = kPeriod});
  add_mirrored_robot(*engine);
  DbcStreamConfig config;
  config.channel.endpoint = kEndpoint;
  config.dbc_file = setting.dbc_file;
  config.signals.push_back({"M", "N", 0, "J_1", JointQuantity::position, 1.0, 0.0});
  // The priority that the gateway gives it.
  auto stream = can::make_dbc_stream(config, clock, {.thread_name = "can", .fifo_priority = 70, .open_channel = {}});
  auto sender = can::open_can_channel(config.channel);
  auto listener = can::open_can_channel(config.channel);
  if (!stream || !sender || !listener || !loop.start() || !(*stream)->open(engine->inlet(0))) {
    std::fprintf(stderr, "cannot set up\n");
    return 1;
  }
  std::vector<double> raw_us;
  std::vector<std::int64_t> sent_ns;
  sent_ns.reserve(1'000'000);
  std::jthread raw([&](const std::stop_token& stop) {
    ReceivedCanFrame received;
    while (!stop.stop_requested()) {
      if ((*listener)->receive(received, std::chrono::milliseconds(50)) != CanReceive::frame) continue;
      std::uint32_t number = 0;
      std::memcpy(&number, received.frame.data.data(), sizeof number);
      raw_us.push_back(1e-3 * static_cast<double>(clock.now().ns - sent_ns[number]));
    }
  });
  std::map<std::uint32_t, std::int64_t> published_ns;
  std::mt19937 chance(5);
  std::uniform_int_distribution<int> pause_us(1500, 4500);  // in no step with the loop
  const Timestamp end = clock.now() + Nanoseconds(static_cast<std::int64_t>(seconds_wanted * 1e9));
  for (std::uint32_t number = 0; clock.now() < end; ++number) {
    sent_ns.push_back(clock.now().ns);
    (*sender)->send(numbered(number));
    if (number % 1000 == 999) collect(*engine, published_ns);
    std::this_thread::sleep_for(std::chrono::microseconds(pause_us(chance)));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  collect(*engine, published_ns);
  raw.request_stop();
  raw.join();
  (*stream)->close();
  loop.stop();
  std::vector<double> latencies_us;
  for (const auto& [number, published] : published_ns) {
    latencies_us.push_back(1e-3 * static_cast<double>(published - sent_ns[number]));
  }
  print("frame sent -> published", latencies_us);
  print("frame sent -> raw listener", raw_us);
  std::sort(latencies_us.begin(), latencies_us.end());
  const double p99 = latencies_us[static_cast<std::size_t>(0.99 * static_cast<double>(latencies_us.size() - 1))];
  std::printf("p99 over (one period + 150 us): %.2f (goal: at most 1)\n", p99 / 1150.0);
  return 0;
}
