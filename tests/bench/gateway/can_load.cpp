// Sends the load of many robots as CAN FD frames over several udp buses: one frame a robot and sample, seven joints of
// 16 bits in it. Prints {"sent": N, "refused": N} at the end.
//   can_load ROBOTS BUSES RATE_HZ SECONDS FIRST_PORT
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/channel/open_channel.hpp"
#include "rt_core/base/time.hpp"

using namespace cellmirror;

namespace {

constexpr int kJoints = 7;
constexpr std::uint32_t kFirstId = 0x100;

CanFrame frame_of(int robot, std::int64_t sample) {
  CanFrame frame;
  frame.id = kFirstId + static_cast<std::uint32_t>(robot);
  frame.fd = true;
  frame.length = 16;
  for (int joint = 0; joint < kJoints; ++joint) {
    const double angle = 0.001 * static_cast<double>(sample) + joint;
    const auto raw = static_cast<std::int16_t>(10'000 * std::sin(angle));
    frame.data[static_cast<std::size_t>(2 * joint)] = static_cast<std::uint8_t>(raw & 0xff);
    frame.data[static_cast<std::size_t>(2 * joint + 1)] = static_cast<std::uint8_t>((raw >> 8) & 0xff);
  }
  return frame;
}

void sleep_until(std::int64_t ns) {
  const timespec t{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: can_load ROBOTS BUSES RATE_HZ SECONDS FIRST_PORT\n");
    return 2;
  }
  const int robots = std::atoi(argv[1]);
  const int buses = std::atoi(argv[2]);
  const double rate = std::atof(argv[3]);
  const auto samples = static_cast<std::int64_t>(std::atof(argv[4]) * rate);
  std::vector<std::unique_ptr<CanChannel>> channels;
  for (int bus = 0; bus < buses; ++bus) {
    CanChannelConfig config;
    config.endpoint = "udp:239.74.163.2:" + std::to_string(std::atoi(argv[5]) + bus);
    config.fd = true;
    auto channel = can::open_can_channel(config);
    if (!channel) {
      std::fprintf(stderr, "%s\n", channel.error().text().c_str());
      return 1;
    }
    channels.push_back(std::move(*channel));
  }
  const auto period = static_cast<std::int64_t>(1e9 / rate);
  const std::int64_t start = SystemClock().now().ns + period;
  long long sent = 0;
  long long refused = 0;
  // Each sample's frames go out in four groups, evenly spread over the period, as independent controllers would.
  constexpr int kGroups = 4;
  for (std::int64_t sample = 0; sample < samples; ++sample) {
    for (int group = 0; group < kGroups; ++group) {
      sleep_until(start + sample * period + group * period / kGroups);
      for (int robot = group; robot < robots; robot += kGroups) {
        const bool done = channels[static_cast<std::size_t>(robot % buses)]->send(frame_of(robot, sample));
        ++(done ? sent : refused);
      }
    }
  }
  std::printf("{\"sent\": %lld, \"refused\": %lld}\n", sent, refused);
  return 0;
}
