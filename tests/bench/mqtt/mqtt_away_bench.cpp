// An hour without a broker, as fast as it goes: eight robots of six joints at 10 Hz, summaries at 2 Hz, ten events a
// second. What the process holds before and after, and what one message costs the thread that gives it.
//   mqtt_away_bench [HOURS]
#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/mqtt/mqtt_gateway.hpp"

using namespace cellmirror;

namespace {

constexpr int kRobots = 8;
constexpr int kJoints = 6;
constexpr int kTenths = 36'000;  // of an hour's seconds
constexpr int kClosedPort = 9;   // discard: nobody listens

double resident_mb() {
  std::ifstream file("/proc/self/statm");
  long all = 0;
  long resident = 0;
  file >> all >> resident;
  return static_cast<double>(resident * ::sysconf(_SC_PAGESIZE)) / 1e6;
}

std::vector<RobotState> make_robots() {
  std::vector<RobotState> out(kRobots);
  for (int i = 0; i < kRobots; ++i) {
    out[i].id = "robot_" + std::to_string(i);
    out[i].joints.resize(kJoints);
    for (int j = 0; j < kJoints; ++j) {
      out[i].joints[j].name = "J_" + std::to_string(j);
      out[i].joints[j].position = 0.1234567 * j;
    }
  }
  return out;
}

CellSummary make_summary() {
  CellSummary out;
  out.cell = "bench";
  for (int i = 0; i < kRobots; ++i) out.robots.push_back({.id = "robot_" + std::to_string(i), .mirrored = true});
  return out;
}

std::uint64_t counter(const mqtt::MqttGateway& gateway, const std::string& name) {
  for (const auto& [key, value] : gateway.counters()) {
    if (key == name) return value;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int hours = argc > 1 ? std::atoi(argv[1]) : 1;
  SystemClock clock;
  MqttConfig config;
  config.broker = "127.0.0.1";
  config.port = kClosedPort;
  config.joint_states_hz = 10;
  config.sparkplug = SparkplugConfig{"hall", "node"};
  mqtt::MqttGateway gateway(config, {"bench", "default", "host", "1"}, clock, {});
  const auto states = gateway.states_output();
  const auto summaries = gateway.summary_output();
  std::vector<RobotState> robots = make_robots();
  CellSummary summary = make_summary();
  const std::string text(2000, 'x');  // as long as that of eight robots
  ProximityState found;
  found.events.resize(1);
  found.events[0].change = ProximityChange::touched;
  found.events[0].a = "robot_0.hand";
  found.events[0].b = "robot_1.hand";
  const double before = resident_mb();
  const auto begin = std::chrono::steady_clock::now();
  Timestamp time = clock.now();
  for (int i = 0; i < hours * kTenths; ++i) {
    time = time + Nanoseconds(100'000'000);
    for (RobotState& robot : robots) robot.joints[0].position = 1e-6 * i;
    states->publish(time, robots, {});
    found.events[0].sequence = static_cast<std::uint64_t>(i) + 1;
    states->publish_proximity(found);
    summary.robots[0].age_s = 1e-3 * i;
    if (i % 5 == 0) summaries->publish(summary, text);
  }
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double messages = hours * kTenths * (kRobots + 1.0 + 0.2);
  fmt::print(
      "{:.0f} messages in {:.2f} s, {:.2f} us each; resident {:.1f} MB before, {:.1f} MB after; waiting {} "
      "messages, {} bytes; dropped {} joint states, {} events\n",
      messages, took, 1e6 * took / messages, before, resident_mb(), counter(gateway, "waiting"),
      counter(gateway, "waiting_bytes"), counter(gateway, "joint_states_dropped"), counter(gateway, "events_dropped"));
  return 0;
}
