// 32 robots of six joints at 500 Hz, half of them mirrored with a new sample each tick, half of them moving: the tick
// with and without a recording of its inputs, the work of the recorder beside it (draining, LZ4, writing), the size,
// and the verification. Times of the processor, so that a busy machine changes little; shares are of one processor in
// real time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

#include "app/replay/engine_replay.hpp"
#include "ipc/record/writer.hpp"
#include "rt_core/engine/engine.hpp"

namespace {

using namespace cellmirror;

constexpr std::size_t kRobots = 32;
constexpr std::uint8_t kJoints = 6;
constexpr Nanoseconds kPeriod{2'000'000};
constexpr std::size_t kTicksPerMessage = 25;
constexpr double kIncrement = 1e-5;  // rad, of a drive

std::int64_t processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

class CountingSink final : public mcap::Sink {
 public:
  Result<void> write(std::span<const mcap::View> parts) override {
    for (const mcap::View part : parts) bytes += part.size();
    return {};
  }
  std::uint64_t bytes = 0;
};

class Cell {
 public:
  Cell() {
    for (std::uint8_t slot = 0; slot < kRobots; ++slot) {
      engine::RobotSetup robot{.joint_count = kJoints};
      robot.limits.lower.fill(-3);
      robot.limits.upper.fill(3);
      engine_.send(
          engine::AddRobot{.slot = slot, .robot = engine_.lend(std::make_shared<const engine::RobotSetup>(robot))});
      if (slot % 2 == 0) engine_.send(engine::SetMode{.slot = slot, .mode = engine::RobotMode::mirrored});
    }
  }

  // The time of the tick itself.
  std::int64_t tick() {
    now_ = now_ + kPeriod;
    const double t = 1e-9 * static_cast<double>(now_.ns);
    for (std::uint8_t slot = 0; slot < kRobots; ++slot) {
      if (slot % 2 == 0) {
        push_sample(slot, t);
      } else if (cycle_ % 400 == 0) {
        add_move(slot);
      }
    }
    CycleContext context;
    context.now = now_ + Nanoseconds(static_cast<std::int64_t>(7919 * cycle_ % 50'000));
    context.scheduled = now_;
    context.cycle = cycle_++;
    context.period = kPeriod;
    context.last_compute = Nanoseconds(20'000 + static_cast<std::int64_t>(cycle_ * 7717 % 5'000));
    const std::int64_t before = processor_ns();
    engine_.run(context);
    return processor_ns() - before;
  }

  engine::InputTap& inputs() { return engine_.inputs(); }

 private:
  void push_sample(std::uint8_t slot, double t) {
    JointSample sample;
    sample.receive_time = now_ - Nanoseconds(300'000 + slot * 1'000);
    sample.sequence = cycle_;
    sample.present = (1U << kJoints) - 1;
    for (std::size_t i = 0; i < kJoints; ++i) {
      const double w = 1.0 + 0.1 * static_cast<double>(slot + i);
      sample.position[i] = kIncrement * std::round(0.5 * std::sin(w * t) / kIncrement);
      sample.velocity[i] = kIncrement * std::round(0.5 * w * std::cos(w * t) / kIncrement);
    }
    engine_.inlet(slot).push(sample);
  }
  void add_move(std::uint8_t slot) {
    auto move = std::make_shared<motion::Move>();
    move->id = static_cast<std::uint32_t>(cycle_ / 400 + 1);
    move->max_velocity.fill(5);
    move->velocity.fill(1);
    move->acceleration.fill(4);
    move->target.fill(cycle_ % 800 == 0 ? 0.6 : -0.6);
    engine_.send(engine::AddMove{.slot = slot, .move = engine_.lend(std::shared_ptr<const motion::Move>(move))});
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  engine::Engine engine_{watchdog_, engine::EngineCapacity{.robots = kRobots}};
  engine::TickReader& reader_ = engine_.subscribe("bench");
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
};

double median_us(std::vector<std::int64_t>& times) {
  std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2));
  return 1e-3 * static_cast<double>(times[times.size() / 2]);
}

std::vector<std::int64_t> run(Cell& cell, std::size_t ticks) {
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < ticks; ++i) times.push_back(cell.tick());
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds_recorded = argc > 1 ? std::atof(argv[1]) : 10.0;
  const auto ticks = static_cast<std::size_t>(seconds_recorded * 500);
  Cell cell;
  run(cell, 500);
  auto without = run(cell, std::min<std::size_t>(ticks, 5'000));
  CountingSink sink;
  mcap::Writer writer(sink, {.compression = mcap::Compression::lz4});
  if (!writer.begin() || !writer.put(mcap::Schema{1, "cellmirror.Inputs", "cellmirror.inputs", ""}) ||
      !writer.put(mcap::Channel{1, 1, "/inputs/ticks", "cellmirror.inputs"}))
    return 1;
  cell.inputs().request_start();
  std::vector<std::int64_t> with;
  std::int64_t recorder_ns = 0;
  std::uint64_t raw = 0;
  std::uint64_t longest = 0;
  app::EngineReplay replay;
  std::int64_t replay_ns = 0;
  for (std::size_t done = 0; done < ticks; done += kTicksPerMessage) {
    for (const std::int64_t time : run(cell, kTicksPerMessage)) with.push_back(time);
    const std::int64_t before = processor_ns();
    std::vector<std::byte> message{std::byte{engine::kInputsVersion}};
    cell.inputs().drain(message);
    if (!writer.put(mcap::Message{.channel = 1, .sequence = static_cast<std::uint32_t>(done), .data = message}))
      return 1;
    recorder_ns += processor_ns() - before;
    raw += message.size();
    longest = std::max<std::uint64_t>(longest, message.size());
    const std::int64_t replay_began = processor_ns();
    replay.take(message);
    replay_ns += processor_ns() - replay_began;
  }
  if (!writer.flush()) return 1;
  const double start_us = 1e-3 * static_cast<double>(*std::ranges::max_element(with.begin(), with.begin() + 25));
  fmt::print("{} robots of {} joints at 500 Hz, {} s\n", kRobots, kJoints, seconds_recorded);
  fmt::print("tick without a recording: {:.1f} us, with: {:.1f} us (median); with the start state: {:.1f} us\n",
             median_us(without), median_us(with), start_us);
  fmt::print("recorder (drain, LZ4, write): {:.3f} of a processor\n",
             1e-9 * static_cast<double>(recorder_ns) / seconds_recorded);
  fmt::print("raw {:.2f} MB/s, LZ4 {:.1f} % of it; largest message {} bytes; ticks lost: {}\n",
             1e-6 * static_cast<double>(raw) / seconds_recorded,
             100.0 * static_cast<double>(sink.bytes) / static_cast<double>(raw), longest, cell.inputs().lost_ticks());
  fmt::print("verified {} ticks, {}: {:.0f} times as fast as real time\n", replay.counts().ticks,
             replay.difference() ? "DIFFERENT" : "equal", seconds_recorded / (1e-9 * static_cast<double>(replay_ns)));
  return replay.difference() || replay.counts().ticks != ticks ? 1 : 0;
}
