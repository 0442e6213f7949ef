// The time of a tick at 1 kHz over the number of mirrored robots of six joints, each with samples at 125 Hz, for one
// reader of the state and for nine, all values checked for plausibility. Processor time of the thread, so that a busy
// machine changes little. Writes a table (CSV) and a figure (PNG).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "app/plot/figure.hpp"
#include "rt_core/engine/engine.hpp"

namespace {

using namespace cellmirror;

constexpr std::uint8_t kJoints = 6;
constexpr std::uint64_t kTicksPerSample = 8;
constexpr std::size_t kTicks = 20'000;
constexpr std::size_t kWarmUp = 1'000;
constexpr Nanoseconds kPeriod{1'000'000};
constexpr std::array<std::size_t, 11> kRobots = {1, 5, 10, 20, 32, 64, 96, 128, 160, 200, 256};

struct TickTimes {
  double median_us = 0;
  double p99_us = 0;
};

std::int64_t processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

void add_mirrored_robot(engine::Engine& engine, std::size_t slot) {
  engine::RobotSetup robot{.joint_count = kJoints};
  robot.limits.lower.fill(-3.0);
  robot.limits.upper.fill(3.0);
  const auto number = static_cast<std::uint8_t>(slot);
  engine.send(
      engine::AddRobot{.slot = number, .robot = engine.lend(std::make_shared<const engine::RobotSetup>(robot))});
  PlausibilityBounds bounds;
  bounds.joints.fill({.lower = -3.0, .upper = 3.0, .velocity = 3.0, .acceleration = 30.0});
  engine.send(engine::SetMode{.slot = number,
                              .mode = engine::RobotMode::mirrored,
                              .plausibility = engine.lend(std::make_shared<const PlausibilityBounds>(bounds))});
}

TickTimes measure(std::size_t robots, std::size_t reader_count) {
  Watchdog watchdog(std::chrono::milliseconds(100), {});
  const auto engine = std::make_unique<engine::Engine>(watchdog, engine::EngineCapacity{.robots = robots});
  std::vector<engine::TickReader*> readers;
  for (std::size_t i = 0; i < reader_count; ++i) readers.push_back(&engine->subscribe(fmt::format("reader {}", i)));
  for (std::size_t slot = 0; slot < robots; ++slot) add_mirrored_robot(*engine, slot);
  JointSample sample;
  sample.present = (1U << kJoints) - 1U;
  CycleContext context;
  context.period = kPeriod;
  std::vector<double> us;
  double seen = 0;
  for (std::size_t i = 0; i < kTicks + kWarmUp; ++i) {
    context.now = context.scheduled = Timestamp{1'000'000'000} + kPeriod * static_cast<std::int64_t>(i);
    sample.receive_time = context.now;
    sample.sequence = i;
    sample.position.fill(1e-4 * static_cast<double>(i));
    for (std::size_t slot = 0; slot < robots; ++slot) {
      if ((i + slot) % kTicksPerSample == 0) engine->inlet(slot).push(sample);
    }
    const std::int64_t begun = processor_ns();
    engine->run(context);
    const std::int64_t ended = processor_ns();
    ++context.cycle;
    for (engine::TickReader* reader : readers) seen += reader->newest().robots[robots - 1].joints[0].position;
    if (i >= kWarmUp) us.push_back(1e-3 * static_cast<double>(ended - begun));
  }
  if (seen <= 0) std::fputs("no reader has seen a sample\n", stderr);
  std::ranges::sort(us);
  return {.median_us = us[us.size() / 2], .p99_us = us[us.size() * 99 / 100]};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: engine_tick CSV PNG\n", stderr);
    return 2;
  }
  std::string table = "robots,readers,median_us,p99_us\n";
  plot::Panel panel;
  panel.x = {.label = "mirrored robots", .low = 0, .high = 260};
  panel.y = {.label = "tick [us]"};
  for (const std::size_t readers : {std::size_t{1}, std::size_t{9}}) {
    const std::string words = readers == 1 ? "1 reader" : fmt::format("{} readers", readers);
    plot::Line median{.label = words + ", median", .x = {}, .y = {}};
    plot::Line p99{.label = words + ", p99", .x = {}, .y = {}};
    for (const std::size_t robots : kRobots) {
      const TickTimes times = measure(robots, readers);
      table += fmt::format("{},{},{:.2f},{:.2f}\n", robots, readers, times.median_us, times.p99_us);
      fmt::print("{:3} robots, {}: median {:.1f} us, p99 {:.1f} us\n", robots, words, times.median_us, times.p99_us);
      median.x.push_back(static_cast<double>(robots));
      median.y.push_back(times.median_us);
      p99.x.push_back(static_cast<double>(robots));
      p99.y.push_back(times.p99_us);
    }
    panel.lines.push_back(median);
    panel.lines.push_back(p99);
  }
  plot::Figure figure;
  figure.title = "Time of a tick over the number of robots";
  figure.subtitle = "six joints each, samples at 125 Hz, tick at 1 kHz, processor time";
  figure.panels.push_back(panel);
  figure.columns = 1;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr || std::fputs(table.c_str(), file) < 0 || std::fclose(file) != 0) {
    fmt::print(stderr, "{} cannot be written\n", arguments[1]);
    return 1;
  }
  if (auto written = plot::write_png(figure, arguments[2]); !written) {
    fmt::print(stderr, "{}\n", written.error().text());
    return 1;
  }
  return 0;
}
