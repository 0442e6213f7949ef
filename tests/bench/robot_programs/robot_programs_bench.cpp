// Twenty robots that run programs at once: what a tick of the loop takes, and what a turn of the thread that owns the
// virtual controllers takes, which plans the moves.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arms.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/motion/planner.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "scripts/programs/controller/controllers.hpp"
#include "scripts/programs/irdata/irdata.hpp"

namespace cellmirror {
namespace {

using program::MotionProgress;
using program::MoveCommand;
using program::TargetKind;

constexpr std::size_t kRobots = 20;
constexpr Nanoseconds kPeriod{1'000'000};

// Lines, an arc and PTP moves that fly, with arithmetic, an output and a pause between them, for ever.
constexpr std::string_view kProgram = R"(10, HEADER, round
20, INTEGER, rounds, 0
30, END_HEADER
40, VEL_LIN, 400
50, ACC_LIN, 1600
60, FLY, DISTANCE, 10
70, LOOP
80, LIN_INC, POSE(0, 0, -60, 0, 0, 0), FLY
90, LIN_INC, POSE(0, 80, 0, 0, 0, 0), FLY
100, CIR_INC, POSE(0, -40, 40, 0, 0, 0), POSE(0, -80, 0, 0, 0, 0)
110, LIN_INC, POSE(0, 0, 60, 0, 0, 0)
120, DOUT, 1, ON
130, PTP_INC, JOINTS(15, 0, 0, 0, 0, 0, 10), FLY
140, PTP_INC, JOINTS(-15, 0, 0, 0, 0, 0, -10)
150, SET, rounds, rounds + 1
160, DOUT, 1, OFF
170, WAIT_TIME, 0.05
180, END_LOOP
190, END
)";

// The robots of an engine, planned as the gateway does.
class EngineMotion final : public program::ProgramMotion {
 public:
  EngineMotion() {
    for (std::size_t i = 0; i < kRobots; ++i) {
      ends_[i] = motion::test_arms::panda_posture();
      engine::RobotSetup setup{.joint_count = 7, .positions = ends_[i]};
      std::ranges::copy(chain_->lower(), setup.limits.lower.begin());
      std::ranges::copy(chain_->upper(), setup.limits.upper.begin());
      const auto slot = static_cast<std::uint8_t>(i);
      engine_->send(
          engine::AddRobot{.slot = slot, .robot = engine_->lend(std::make_shared<const engine::RobotSetup>(setup))});
      engine_->send(engine::SetChain{.slot = slot, .chain = engine_->lend(chain_)});
    }
    parameters_.max_velocity.fill(2.0);
    parameters_.max_acceleration.fill(8.0);
    parameters_.linear_acceleration = 4.0;
    tick();
  }

  void tick() {
    clock.advance(kPeriod);
    CycleContext context;
    context.now = context.scheduled = clock.now();
    context.cycle = cycle_++;
    context.period = kPeriod;
    engine_->run(context);
  }
  [[nodiscard]] std::size_t moving() {
    return static_cast<std::size_t>(
        std::ranges::count_if(ticks_.newest().robots, [](const auto& robot) { return robot.motion.moving; }));
  }

  Result<void> check(std::string_view /*robot*/) const override { return {}; }
  [[nodiscard]] bool room(std::string_view robot) const override {
    return ids_[slot(robot)] - state(robot).motion.finished < motion::kMoveQueue;
  }
  Result<std::uint32_t> move(std::string_view robot, const MoveCommand& command, Timestamp begin) override {
    const std::size_t i = slot(robot);
    auto planned = plan(command, ends_[i]);
    if (!planned) return std::unexpected(planned.error());
    planned->begin = begin;
    return give(i, *planned);
  }
  Result<std::uint32_t> delay(std::string_view robot, double seconds, Timestamp begin) override {
    motion::Move move;
    move.kind = motion::MoveKind::delay;
    move.delay_s = seconds;
    move.begin = begin;
    return give(slot(robot), move);
  }
  Result<void> set_tool(std::string_view /*robot*/, const std::optional<Pose>& /*X_PT*/) override { return {}; }
  [[nodiscard]] MotionProgress progress(std::string_view robot) const override {
    const motion::MotionState& motion = state(robot).motion;
    MotionProgress progress;
    progress.finished = motion.finished;
    if (motion.outcome == motion::Outcome::blocked) progress.end = MotionProgress::End::blocked;
    progress.finished_time = motion.finished_time;
    progress.moving = motion.moving || motion.finished < ids_[slot(robot)];
    progress.pace = motion.pace;
    return progress;
  }
  Result<void> set_pace(std::string_view /*robot*/, double /*pace*/) override { return {}; }
  Result<void> hold_behind(std::string_view /*robot*/, std::uint32_t /*ticket*/) override { return {}; }
  Result<void> stop(std::string_view /*robot*/) override { return {}; }
  [[nodiscard]] std::span<const JointKind> joint_kinds(std::string_view /*robot*/) const override { return kinds_; }
  [[nodiscard]] JointValues joints(std::string_view robot) const override {
    JointValues q{};
    for (std::size_t i = 0; i < 7; ++i) q[i] = state(robot).joints[i].position;
    return q;
  }
  [[nodiscard]] Result<Pose> position(std::string_view robot) const override { return tcp(joints(robot)); }
  [[nodiscard]] double program_delay(std::string_view /*robot*/) const override { return 0; }

  static std::string name(std::size_t i) { return "R" + std::to_string(i); }
  ManualClock clock;

 private:
  static std::size_t slot(std::string_view robot) {
    return static_cast<std::size_t>(std::atoi(std::string(robot.substr(1)).c_str()));
  }
  [[nodiscard]] const engine::RobotTickState& state(std::string_view robot) const {
    return ticks_.newest().robots[slot(robot)];
  }
  [[nodiscard]] Pose tcp(const JointValues& q) const { return kinematics::forward(*chain_, std::span(q).first(7)); }
  static Pose relative(const Pose& X, const Pose& by) {
    Pose out = X;
    out.translation() += by.translation();
    out.linear() = by.linear() * X.linear();
    return out;
  }

  Result<motion::Move> plan(const MoveCommand& command, JointValues& end) const {
    RobotParameters parameters = parameters_;
    if (command.settings.linear_velocity) parameters.linear_velocity = *command.settings.linear_velocity;
    if (command.settings.linear_acceleration) parameters.linear_acceleration = *command.settings.linear_acceleration;
    if (command.fly && command.settings.fly_type) {
      parameters.fly_type = *command.settings.fly_type;
      parameters.fly_parameter = command.settings.fly_parameter;
    }
    if (command.target.kind == TargetKind::joints_relative) {
      for (std::size_t i = 0; i < 7; ++i) end[i] += command.target.joints[i];
      auto move = motion::plan_joint_move(*chain_, parameters, end);
      if (move) move->fly_parameter = parameters.fly_parameter;
      return move;
    }
    const Pose X = tcp(end);
    const Pose X_BG = relative(X, command.target.pose);
    auto planned = command.via ? motion::plan_circular_move(*chain_, parameters, end,
                                                            relative(X, command.via->pose).translation(), X_BG)
                               : motion::plan_linear_move(*chain_, parameters, end, X_BG);
    if (!planned) return std::unexpected(planned.error());
    end = planned->end;
    return planned->move;
  }
  Result<std::uint32_t> give(std::size_t i, motion::Move move) {
    move.start = motion::Start::queue;
    move.follows_on = true;
    move.id = ++ids_[i];
    engine::Command command = engine::AddMove{.slot = static_cast<std::uint8_t>(i),
                                              .move = engine_->lend(std::make_shared<const motion::Move>(move))};
    while (engine_->send(command) == 0) tick();
    return move.id;
  }

  std::shared_ptr<const kinematics::Chain> chain_ =
      std::make_shared<const kinematics::Chain>(motion::test_arms::panda());
  Watchdog watchdog_{std::chrono::seconds(1), {}};
  std::unique_ptr<engine::Engine> engine_ = std::make_unique<engine::Engine>(watchdog_);
  engine::TickReader& ticks_ = engine_->subscribe("bench");
  RobotParameters parameters_;
  std::array<JointValues, kRobots> ends_{};
  std::array<std::uint32_t, kRobots> ids_{};
  std::vector<JointKind> kinds_ = std::vector<JointKind>(7, JointKind::revolute);
  std::uint64_t cycle_ = 0;
};

class NoScripts final : public program::ProgramScripts {
 public:
  Result<ActivityHandle> execute(std::string_view /*text*/, std::string_view /*source*/) override {
    return ActivityHandle();
  }
};

double microseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

double percentile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// One iteration is a millisecond of the twenty robots.
void twenty_programs(benchmark::State& state) {
  EngineMotion motion;
  NoScripts scripts;
  program::Controllers controllers(motion, scripts, motion.clock);
  Diagnostics diagnostics;
  const auto program = program::irdata_language().parse(kProgram, {.file = "round.ird", .codes = {}}, diagnostics);
  if (!program) return state.SkipWithError(diagnostics.text().c_str());
  for (std::size_t i = 0; i < kRobots; ++i) {
    const std::string robot = EngineMotion::name(i);
    if (!controllers.load(robot, "round", program) ||
        !controllers.run(robot, "round", program::Controllers::Begin::now)) {
      return state.SkipWithError("a program cannot be run");
    }
    // Not all at the same place of their programs.
    for (int ms = 0; ms < 37; ++ms) {
      motion.tick();
      controllers.follow();
    }
  }
  std::vector<double> ticks;
  std::vector<double> turns;
  std::size_t moving = 0;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    motion.tick();
    ticks.push_back(microseconds_since(start));
    start = std::chrono::steady_clock::now();
    controllers.follow();
    turns.push_back(microseconds_since(start));
    moving += motion.moving();
  }
  if (controllers.failures() != 0) return state.SkipWithError(controllers.last_failure().c_str());
  state.counters["robots_moving"] = static_cast<double>(moving) / static_cast<double>(ticks.size());
  state.counters["tick_us_median"] = percentile(ticks, 0.5);
  state.counters["tick_us_p999"] = percentile(ticks, 0.999);
  state.counters["tick_us_most"] = percentile(ticks, 1);
  state.counters["turn_us_median"] = percentile(turns, 0.5);
  state.counters["turn_us_p99"] = percentile(turns, 0.99);
  state.counters["turn_us_most"] = percentile(turns, 1);
}
BENCHMARK(twenty_programs)->Iterations(30'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
