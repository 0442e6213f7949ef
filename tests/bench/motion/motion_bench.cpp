// What moving robots cost the tick.
#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <span>

#include "arms.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/motion/planner.hpp"

namespace cellmirror {
namespace {

using motion::Move;

constexpr double kTick = 1e-3;

RobotParameters parameters() {
  RobotParameters p;
  p.max_velocity.fill(2.0);
  p.active_velocity.fill(1.0);
  p.max_acceleration.fill(8.0);
  p.active_acceleration.fill(4.0);
  p.linear_velocity = 0.2;
  return p;
}

// There and back, for ever.
class Shuttle {
 public:
  Shuttle(const kinematics::Chain& chain, const JointValues& from, bool linear) : chain_(chain) {
    const std::span<const double> q = std::span(from).first(chain.variable_count());
    Pose there = kinematics::forward(chain, q);
    const Pose back = there;
    there.translation().y() -= 0.2;
    const auto out = motion::plan_linear_move(chain, parameters(), from, there).value();
    if (linear) {
      moves_ = {out.move, motion::plan_linear_move(chain, parameters(), out.end, back).value().move};
    } else {
      moves_ = {motion::plan_joint_move(chain, parameters(), out.end).value(),
                motion::plan_joint_move(chain, parameters(), from).value()};
    }
  }

  const Move& next() {
    Move& move = moves_[id_ % 2];
    move.id = ++id_;
    move.start = motion::Start::queue;
    return move;
  }
  [[nodiscard]] const kinematics::Chain& chain() const { return chain_; }

 private:
  const kinematics::Chain& chain_;
  std::array<Move, 2> moves_;
  std::uint32_t id_ = 0;
};

void one_step(benchmark::State& state, const kinematics::Chain& chain, const JointValues& from, bool linear) {
  Shuttle shuttle(chain, from, linear);
  auto executor = std::make_unique<motion::MoveExecutor>();
  const std::size_t n = chain.variable_count();
  executor->reset(n);
  executor->set_chain(&chain);
  JointValues q = from;
  JointValues qd{};
  for (auto _ : state) {
    if (executor->state().waiting == 0) executor->add(shuttle.next());
    executor->step(kTick, Timestamp{1}, {chain.lower(), chain.upper()}, std::span(q).first(n), std::span(qd).first(n));
    benchmark::DoNotOptimize(q);
  }
}

void six_joints_ptp(benchmark::State& state) {
  one_step(state, motion::test_arms::puma(), motion::test_arms::puma_posture(), false);
}
void six_joints_linear(benchmark::State& state) {
  one_step(state, motion::test_arms::puma(), motion::test_arms::puma_posture(), true);
}
void seven_joints_linear(benchmark::State& state) {
  one_step(state, motion::test_arms::panda(), motion::test_arms::panda_posture(), true);
}
BENCHMARK(six_joints_ptp);
BENCHMARK(six_joints_linear);
BENCHMARK(seven_joints_linear);

// The whole tick with 32 robots that move: what it takes beside 32 that stand is the motion.
void tick_of_32_robots(benchmark::State& state, bool moving, bool linear) {
  constexpr std::size_t kRobots = 32;
  const auto chain = std::make_shared<const kinematics::Chain>(motion::test_arms::panda());
  Watchdog watchdog(std::chrono::milliseconds(100), {});
  const auto engine = std::make_unique<engine::Engine>(watchdog, engine::EngineCapacity{.robots = kRobots});
  engine->subscribe("bench");
  Shuttle shuttle(*chain, motion::test_arms::panda_posture(), linear);
  for (std::size_t slot = 0; slot < kRobots; ++slot) {
    engine::RobotSetup setup{.joint_count = 7, .positions = motion::test_arms::panda_posture()};
    std::ranges::copy(chain->lower(), setup.limits.lower.begin());
    std::ranges::copy(chain->upper(), setup.limits.upper.begin());
    const auto number = static_cast<std::uint8_t>(slot);
    engine->send(
        engine::AddRobot{.slot = number, .robot = engine->lend(std::make_shared<const engine::RobotSetup>(setup))});
    engine->send(engine::SetChain{.slot = number, .chain = engine->lend(chain)});
  }
  CycleContext context;
  context.period = Nanoseconds(1'000'000);
  for (auto _ : state) {
    if (moving && context.cycle % 500 == 0) {
      state.PauseTiming();
      const Move& move = shuttle.next();
      for (std::size_t slot = 0; slot < kRobots; ++slot) {
        engine->send(engine::AddMove{.slot = static_cast<std::uint8_t>(slot),
                                     .move = engine->lend(std::make_shared<const Move>(move))});
      }
      state.ResumeTiming();
    }
    context.now = Timestamp(static_cast<std::int64_t>(1'000'000 * (context.cycle + 1)));
    context.scheduled = context.now;
    engine->run(context);
    ++context.cycle;
  }
}
void tick_32_standing(benchmark::State& state) { tick_of_32_robots(state, false, true); }
void tick_32_ptp(benchmark::State& state) { tick_of_32_robots(state, true, false); }
void tick_32_linear(benchmark::State& state) { tick_of_32_robots(state, true, true); }
BENCHMARK(tick_32_standing);
BENCHMARK(tick_32_ptp);
BENCHMARK(tick_32_linear);

}  // namespace
}  // namespace cellmirror

BENCHMARK_MAIN();
