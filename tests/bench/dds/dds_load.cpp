// Publishes joint states of many robots, paced, for a bounded time.
//   dds_load [--domain 0] [--robots 32] [--joints 7] [--rate 500] [--seconds 10] [--topics 1] [--burst]
// Robot r's joints are robot_<r>/joint_<j>. One topic: rt/joint_states; several: rt/robot_<r>/joint_states, shared
// round robin. The robots are spread over the period, or with --burst sent at one instant.
#include <time.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "drivers/dds/joint_state_publisher.hpp"
#include "rt_core/base/time.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::dds;

struct Load {
  int domain = 0;
  int robots = 32;
  int joints = 7;
  double rate_hz = 500;
  double seconds = 10;
  int topics = 1;
  bool burst = false;
};

JointState message_of(int robot, int joints) {
  JointState message;
  for (int j = 0; j < joints; ++j) {
    message.name.push_back("robot_" + std::to_string(robot) + "/joint_" + std::to_string(j));
  }
  message.position.resize(message.name.size());
  message.velocity.resize(message.name.size());
  message.effort.resize(message.name.size());
  return message;
}

void sleep_until(std::int64_t monotonic_ns) {
  const timespec until{monotonic_ns / 1'000'000'000, monotonic_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

int run(const Load& load) {
  std::vector<std::unique_ptr<JointStatePublisher>> publishers;
  for (int t = 0; t < load.topics; ++t) {
    JointStatePublisherConfig config;
    config.domain = load.domain;
    config.depth = 256;
    if (load.topics > 1) config.topic = "rt/robot_" + std::to_string(t) + "/joint_states";
    auto publisher = JointStatePublisher::make(config);
    if (!publisher) {
      std::fprintf(stderr, "dds_load: %s\n", publisher.error().text().c_str());
      return 1;
    }
    publishers.push_back(std::move(*publisher));
  }
  for (int tries = 0; tries < 200 && publishers.back()->matched_readers() == 0; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::vector<JointState> messages;
  for (int r = 0; r < load.robots; ++r) messages.push_back(message_of(r, load.joints));

  SystemClock clock;
  const double period_ns = 1e9 / load.rate_hz;
  const auto cycles = static_cast<std::int64_t>(load.seconds * load.rate_hz);
  const std::int64_t begin_ns = clock.now().ns + 1'000'000;
  std::uint64_t sent = 0;
  std::uint64_t refused = 0;
  for (std::int64_t cycle = 0; cycle < cycles; ++cycle) {
    for (int r = 0; r < load.robots; ++r) {
      const double phase = load.burst ? 0.0 : static_cast<double>(r) / load.robots;
      sleep_until(begin_ns + static_cast<std::int64_t>((static_cast<double>(cycle) + phase) * period_ns));
      JointState& message = messages[static_cast<std::size_t>(r)];
      message.header.stamp = ros_time(to_wall_clock_ns(clock.now()));
      for (double& position : message.position) position = std::sin(1e-3 * static_cast<double>(cycle));
      (publishers[static_cast<std::size_t>(r % load.topics)]->publish(message) ? sent : refused)++;
    }
  }
  const double took_s = 1e-9 * static_cast<double>(clock.now().ns - begin_ns);
  std::printf("%llu %llu %.3f\n", static_cast<unsigned long long>(sent), static_cast<unsigned long long>(refused),
              took_s);
  std::fflush(stdout);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // for the reliable readers' last repetitions
  return 0;
}

constexpr char kUsage[] =
    "usage: dds_load [--domain 0..232] [--robots 1..64] [--joints 1..16] [--rate 1..4000] [--seconds 0.1..600] "
    "[--topics 1..64] [--burst]\n"
    "Publishes joint states of many robots. Prints: samples sent, samples refused, seconds.\n";

bool read_number(const char* text, double least, double most, double& value) {
  char* end = nullptr;
  value = std::strtod(text, &end);
  return end != text && *end == '\0' && value >= least && value <= most;
}

bool read_number(const char* text, int least, int most, int& value) {
  double number = 0;
  if (!read_number(text, static_cast<double>(least), static_cast<double>(most), number)) return false;
  value = static_cast<int>(number);
  return number == value;
}

// By hand: the library that the programs of app/ use takes ten seconds to compile.
bool read_option(std::string_view name, const char* value, Load& load) {
  if (name == "--domain") return read_number(value, 0, 232, load.domain);
  if (name == "--robots") return read_number(value, 1, 64, load.robots);
  if (name == "--joints") return read_number(value, 1, 16, load.joints);
  if (name == "--rate") return read_number(value, 1.0, 4000.0, load.rate_hz);
  if (name == "--seconds") return read_number(value, 0.1, 600.0, load.seconds);
  if (name == "--topics") return read_number(value, 1, 64, load.topics);
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  Load load;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--burst") {
      load.burst = true;
    } else if (i + 1 < argc && read_option(argv[i], argv[i + 1], load)) {
      ++i;
    } else {
      std::fputs(kUsage, stderr);
      return 2;
    }
  }
  return run(load);
}
