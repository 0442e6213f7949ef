// Whatever comes in, on whatever way: what comes out is finite, within its limits, and as fresh as it says. Hostile
// values are driven through the gates themselves and through each way of an engine.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "arms.hpp"

#include "rt_core/engine/joint_gate.hpp"
#include "rt_core/haptics/force_gate.hpp"
#include "tests/unit/engine/commands.hpp"

namespace cellmirror::engine {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPeriod_s = 1e-3;

// About every third is one that no owner and no driver should ever give.
double hostile(double usual) {
  const int kind = *rc::gen::inRange(0, 6);
  if (kind == 0) {
    return *rc::gen::element(std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity,
                             std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(),
                             std::numeric_limits<double>::denorm_min(), 0.0);
  }
  if (kind == 1) return *rc::gen::arbitrary<double>();
  return usual * *rc::gen::inRange(-1000, 1001) * 1e-3;
}

JointValues hostile_values(double usual) {
  JointValues values{};
  for (std::size_t i = 0; i < 3; ++i) values[i] = hostile(usual);
  return values;
}

// Mostly good, so that something gets through.
JointValues values_near(const JointValues& middle, double usual) {
  JointValues values = middle;
  for (std::size_t i = 0; i < 3; ++i) values[i] += *rc::gen::inRange(-1000, 1001) * 1e-3 * usual;
  if (*rc::gen::inRange(0, 4) == 0) values[static_cast<std::size_t>(*rc::gen::inRange(0, 3))] = hostile(usual);
  return values;
}

// Where a position may be after a step from `before`.
bool within_reach(double before, double after, double lower, double upper) {
  if (after == before) return true;
  return after >= std::min(lower, before) - kLimitSlack && after <= std::max(upper, before) + kLimitSlack;
}

bool at_most(double value, double limit, double slack) { return std::abs(value) <= limit * (1 + kRateSlack) + slack; }

void expect_finite(const RobotTickState& robot) {
  for (std::size_t i = 0; i < robot.joint_count; ++i) {
    RC_ASSERT(std::isfinite(robot.joints[i].position));
    RC_ASSERT(std::isfinite(robot.joints[i].velocity));
    RC_ASSERT(std::isfinite(robot.joints[i].effort));
  }
}

JointLimits limits_with_rates(double range) {
  JointLimits limits = robot_of(3, -range, range).limits;
  limits.velocity.fill(1.0);
  limits.acceleration.fill(20.0);
  limits.jerk.fill(20'000.0);
  return limits;
}

RC_GTEST_PROP(JointGateProperty, LetsNoStepOfASimulatedRobotBeyondItsLimits, ()) {
  JointGate sut;
  const JointLimits limits = limits_with_rates(0.1);
  RC_ASSERT(sut.add(3, JointValues{}, limits) == LimiterVerdict::passed);
  std::array<JointRate, 3> rates{};
  std::uint64_t passed = 0;
  for (int i = 0; i < 60; ++i) {
    const RobotTickState before = sut.state();
    GatedStep step{.joints = static_cast<JointSet>(*rc::gen::inRange(0, 8)), .dt = kPeriod_s};
    JointValues present{};
    for (std::size_t j = 0; j < 3; ++j) present[j] = before.joints[j].position + rates[j].velocity * kPeriod_s;
    step.next = values_near(present, *rc::gen::element(1e-5, 1e-3, 0.3));
    step.velocity = values_near({}, 1.0);
    step.fastest.fill(*rc::gen::element(0.5, 2.0, kInfinity));
    if (*rc::gen::inRange(0, 10) == 0) step.fastest[0] = hostile(1.0);
    const bool taken = sut.step(step) == LimiterVerdict::passed;
    passed += taken ? 1 : 0;
    RC_ASSERT(sut.state().refused_setpoints == before.refused_setpoints + (taken ? 0 : 1));
    expect_finite(sut.state());
    for (std::size_t j = 0; j < 3; ++j) {
      const double way = sut.state().joints[j].position - before.joints[j].position;
      const bool concerned = ((step.joints >> j) & 1U) != 0;
      if (!concerned || !taken) {
        RC_ASSERT(way == 0.0);
        if (concerned) rates[j] = {};  // it stands
        continue;
      }
      RC_ASSERT(within_reach(before.joints[j].position, sut.state().joints[j].position, -0.1, 0.1));
      const JointRate now{.velocity = way / kPeriod_s,
                          .acceleration = (way / kPeriod_s - rates[j].velocity) / kPeriod_s};
      RC_ASSERT(at_most(way, std::min(1.0, step.fastest[j]) * kPeriod_s, 2 * kLimitSlack));
      RC_ASSERT(at_most(now.acceleration, 20.0, 2 * kLimitSlack / (kPeriod_s * kPeriod_s)));
      RC_ASSERT(at_most(now.acceleration - rates[j].acceleration, 20'000.0 * kPeriod_s,
                        2 * kLimitSlack / (kPeriod_s * kPeriod_s)));
      rates[j] = now;
    }
  }
  RC_CLASSIFY(passed > 0, "something passed");
}

RC_GTEST_PROP(JointGateProperty, LetsNothingHostileThroughByJumpsOrStarts, ()) {
  JointGate sut;
  const JointLimits limits{.lower = hostile_values(1.0), .upper = hostile_values(1.0)};
  const JointValues start = hostile_values(0.5);
  const bool added = sut.add(3, start, limits) == LimiterVerdict::passed;
  RC_ASSERT(added == (sut.state().mode == RobotMode::simulated));
  for (int i = 0; i < 10; ++i) {
    const RobotTickState before = sut.state();
    const bool taken = sut.jump(hostile_values(0.5), 0b101) == LimiterVerdict::passed;
    expect_finite(sut.state());
    for (std::size_t j = 0; j < sut.state().joint_count; ++j) {
      const double position = sut.state().joints[j].position;
      if (!taken || j == 1) RC_ASSERT(position == before.joints[j].position);
      RC_ASSERT(position >= limits.lower[j] - kLimitSlack);
      RC_ASSERT(position <= limits.upper[j] + kLimitSlack);
    }
  }
}

JointSample hostile_sample(Timestamp now, double usual) {
  JointSample sample;
  sample.sequence = *rc::gen::arbitrary<std::uint64_t>();
  sample.present = static_cast<std::uint32_t>(*rc::gen::inRange(0, 16));
  sample.refused = *rc::gen::inRange(0, 4) == 0 ? 0b010 : 0;
  sample.position = values_near({}, usual);
  sample.velocity = values_near({}, usual);
  sample.effort = values_near({}, usual);
  const auto age = *rc::gen::element<std::int64_t>(0, 0, 0, -500'000, 1'000'000, 8'000'000, 30'000'000, 900'000'000'000,
                                                   -1'000'000'000, -900'000'000'000);
  sample.receive_time = *rc::gen::inRange(0, 10) == 0 ? Timestamp() : now - Nanoseconds(age);
  return sample;
}

constexpr StreamAges kAges{Nanoseconds(5'000'000), Nanoseconds(20'000'000)};

// What a mirrored robot says of itself at `now`.
void expect_honest(const RobotTickState& robot, Timestamp now) {
  expect_finite(robot);
  for (std::size_t i = 0; i < robot.joint_count; ++i) {
    if (robot.joints[i].state != DataState::fresh) continue;
    RC_ASSERT(robot.joints[i].receive_time.known());
    RC_ASSERT(now - robot.joints[i].receive_time <= kAges.stale_after);
    RC_ASSERT(robot.joints[i].receive_time - now <= Nanoseconds(100'000'000));
  }
}

RC_GTEST_PROP(JointGateProperty, TellsTheTruthAboutWhatAStreamBrings, ()) {
  JointGate sut;
  RC_ASSERT(sut.add(3, JointValues{}, robot_of(3, -1.0, 1.0).limits) == LimiterVerdict::passed);
  sut.set_mode(RobotMode::mirrored, kAges, static_cast<JointSet>(*rc::gen::inRange(0, 8)));
  Timestamp now{1'000'000'000'000};
  for (int i = 0; i < 40; ++i) {
    now = now + Nanoseconds(1'000'000);
    const RobotTickState before = sut.state();
    const JointSample sample = hostile_sample(now, 10.0);
    if (*rc::gen::inRange(0, 3) != 0) sut.take(sample, now);
    sut.age(now);
    expect_honest(sut.state(), now);
    for (std::size_t j = 0; j < 3; ++j) {
      const double position = sut.state().joints[j].position;
      RC_ASSERT(position == before.joints[j].position || position == sample.position[j]);
      if (sut.state().joints[j].state == DataState::invalid) RC_ASSERT(position == before.joints[j].position);
    }
  }
}

// --- Forces.

HapticOutput hostile_output(double usual) {
  HapticOutput output;
  for (int i = 0; i < 3; ++i) output.force_D[i] = *rc::gen::inRange(-1000, 1001) * 1e-3 * usual;
  switch (*rc::gen::inRange(0, 12)) {
    case 0:
      output.force_D[*rc::gen::inRange(0, 3)] = hostile(usual);
      break;
    case 1:
      output.force_E[*rc::gen::inRange(0, 3)] = hostile(usual);
      break;
    case 2:
      output.torque_D[*rc::gen::inRange(0, 3)] = hostile(usual);
      break;
    case 3:
      output.gripper_torque = hostile(usual);
      break;
    case 4:
      output.joint_torques = hostile_values(usual);
      break;
    default:
      break;
  }
  return output;
}

// Keeps what it was given, and checks it.
class CheckingDevice final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& out) CELL_RT override {
    out = sample;
    return next;
  }
  void write(const HapticOutput& output) CELL_RT override {
    const Eigen::Vector3d before = last.force_D;
    last = output;
    ++written;
    good = good && output.force_D.allFinite() && output.force_E.allFinite() && output.torque_D.allFinite() &&
           std::isfinite(output.gripper_torque) &&
           std::ranges::all_of(output.joint_torques, [](double torque) { return std::isfinite(torque); });
    good = good && at_most(output.force_D.norm(), limits.largest, 1e-9);
    const double step = limits.largest_rate * kPeriod_s;
    good =
        good && (at_most((output.force_D - before).norm(), step, 1e-9) || at_most(output.force_D.norm(), step, 1e-9));
  }

  HapticRead next = HapticRead::none;
  HapticSample sample;
  HapticOutput last;
  haptics::ForceLimits limits{.largest = 8.0, .largest_rate = 4000.0};
  std::uint64_t written = 0;
  bool good = true;
};

RC_GTEST_PROP(ForceGateProperty, NoForceReachesTheDeviceThatIsNotWithinItsLimits, ()) {
  CheckingDevice device;
  haptics::ForceGate sut;
  sut.open(device);
  for (int i = 0; i < 60; ++i) {
    HapticOutput output = hostile_output(*rc::gen::element(0.5, 6.0, 50.0));
    if (*rc::gen::inRange(0, 2) == 0) {
      const Eigen::Vector3d limited = sut.limit(output.force_D, device.limits, kPeriod_s);
      RC_ASSERT(limited.allFinite());
      RC_ASSERT(at_most(limited.norm(), device.limits.largest, 1e-9));
      output.force_D = limited;
    }
    const bool admitted = sut.admits(output, device.limits, kPeriod_s);
    RC_ASSERT(sut.write(output, device.limits, kPeriod_s) == admitted);
    RC_ASSERT(device.good);
    if (admitted) {
      RC_ASSERT(device.last.force_D == output.force_D);
    } else {
      RC_ASSERT(device.last.force_D.isZero(0));
      RC_ASSERT(device.last.force_E.isZero(0));
      RC_ASSERT(device.last.torque_D.isZero(0));
      RC_ASSERT(device.last.joint_torques == JointValues{});
    }
  }
  RC_ASSERT(device.written == 60U);
}

// --- All ways of an engine at once. 0: simulated, with moves; 1: a slave of 2, which is mirrored; 3: the instrument of
// a haptic device.
class HostileCell {
 public:
  static constexpr std::size_t kRobots = 4;
  static constexpr std::uint8_t kMoved = 0;
  static constexpr std::uint8_t kSlave = 1;
  static constexpr std::uint8_t kMirrored = 2;
  static constexpr std::uint8_t kInstrument = 3;

  HostileCell() {
    for (std::size_t slot = 0; slot < kRobots; ++slot) {
      RobotSetup robot = robot_of(3, -0.5, 0.5);
      // Not of accelerations: what makes moves keeps none that was not asked for.
      robot.limits.velocity.fill(2.0);
      limits_[slot].push_back(robot.limits);
      send_robot(engine_, slot, robot);
    }
    for (const std::uint8_t slot : {kMirrored, kInstrument})
      engine_.send(SetMode{.slot = slot, .mode = RobotMode::mirrored, .ages = kAges});
    Coupling coupling{.master = kMirrored, .slave = kSlave, .count = 2};
    coupling.joints[0] = {.master_joint = 0, .slave_joint = 2};
    coupling.joints[1] = {.master_joint = 1, .slave_joint = 0};
    coupling.max_velocity.fill(1.0);
    send_coupling(engine_, coupling);
    engine_.send(SetChain{.slot = kMoved, .chain = engine_.lend(chain_)});
    haptics::Instrument instrument{
        .slot = kInstrument, .joint_count = 3, .chain = *chain_, .variable_joint = {0, 1, 2}, .settings = {}};
    instrument.lower.fill(-0.5);
    instrument.upper.fill(0.5);
    instrument.settings.engage_time = Nanoseconds(5'000'000);
    instrument.settings.max_force = device_->limits.largest;
    instrument.settings.max_slew = device_->limits.largest_rate;
    engine_.send(OpenHaptic{.channel = 0,
                            .instrument = engine_.lend(std::make_shared<const haptics::Instrument>(instrument)),
                            .device = engine_.lend<HapticDevicePort>(device_)});
    device_->sample.valid = true;
    device_->sample.writer = 1;
    tick();
    RC_ASSERT(ticks_.newest().commands_refused == 0U);
  }

  void act() {
    switch (*rc::gen::inRange(0, 11)) {
      case 0:
        jump(*rc::gen::element(kMoved, kSlave, kMirrored));
        break;
      case 1:
      case 2:
        move();
        break;
      case 3:
        engine_.send(SetPace{.slot = kMoved, .pace = hostile(1.0)});
        break;
      case 4:
        engine_.send(SetPace{.slot = kMoved, .pace = 1.0});
        engine_.send(StopMotion{*rc::gen::element(kMoved, kSlave)});
        break;
      case 5:
        narrow(*rc::gen::element(kMoved, kSlave));
        break;
      case 6:
      case 7:
        engine_.inlet(kMirrored).push(hostile_sample(now_, 0.3));
        break;
      case 8:
        engine_.send(ResetHaptic{0});
        break;
      default:
        hand();
        break;
    }
  }

  // Mostly a good sample of a hand that moves about the wall.
  void hand() {
    device_->next = *rc::gen::element(HapticRead::fresh, HapticRead::fresh, HapticRead::fresh, HapticRead::fresh,
                                      HapticRead::unchanged, HapticRead::torn);
    ++device_->sample.sequence;
    device_->sample.time = now_;
    for (int i = 0; i < 3; ++i)
      device_->sample.p_DH[i] = std::clamp(
          (std::isfinite(device_->sample.p_DH[i]) ? device_->sample.p_DH[i] : 0.0) + *rc::gen::inRange(-2, 3) * 1e-3,
          -0.02, 0.02);
    if (*rc::gen::inRange(0, 60) == 0) device_->sample.p_DH[0] = hostile(0.1);
  }

  void tick() {
    give_surroundings();
    now_ = now_ + kPeriod;
    run_cycle(engine_, now_, cycle_);
  }

  void tick_and_check() {
    const TickState before = ticks_.newest();
    tick();
    const TickState& after = ticks_.newest();
    for (const std::uint8_t slot : {kMoved, kSlave}) check_simulated(slot, before.robots[slot], after.robots[slot]);
    for (const std::uint8_t slot : {kMirrored, kInstrument}) expect_honest(after.robots[slot], now_);
    for (std::size_t i = 0; i < 3; ++i) {
      const double position = after.robots[kInstrument].joints[i].position;
      RC_ASSERT(std::abs(position) <= 0.5 + kLimitSlack);
    }
    const RobotTickState& slave = after.robots[kSlave];
    if (slave.follow.follows() && after.robots[kMirrored].joints[0].state != DataState::fresh) {
      RC_ASSERT(slave.follow.holding);
      RC_ASSERT(slave.joints[2].position == before.robots[kSlave].joints[2].position);
    }
    RC_ASSERT(device_->good);
    jumped_ = {};
    moved_ = moved_ || after.robots[kMoved].motion.moving;
    touched_ = touched_ || device_->last.force_D.norm() > 0;
  }

  [[nodiscard]] bool moved() const { return moved_; }
  [[nodiscard]] bool touched() const { return touched_; }

 private:
  void jump(std::uint8_t slot) {
    engine_.send(SetPositions{.slot = slot, .positions = values_near({}, 0.4)});
    jumped_[slot] = true;
  }

  void move() {
    motion::Move move;
    move.id = ++newest_move_;
    move.kind = *rc::gen::element(motion::MoveKind::joints, motion::MoveKind::joints, motion::MoveKind::linear);
    move.start = *rc::gen::element(motion::Start::supersede, motion::Start::queue);
    move.profile = *rc::gen::element(VelocityProfile::sine, VelocityProfile::ramp);
    move.target = values_near({}, 0.4);
    move.max_velocity.fill(*rc::gen::element(1.0, 2.0, 50.0));
    move.velocity = move.max_velocity;
    move.acceleration.fill(*rc::gen::element(5.0, 50.0, 1e6));
    if (*rc::gen::inRange(0, 4) == 0) move.velocity[0] = hostile(2.0);
    if (*rc::gen::inRange(0, 4) == 0) move.acceleration[1] = hostile(10.0);
    move.X_BG.translation() = Eigen::Vector3d(hostile(0.4), 0.1, 0.1);
    move.task = kinematics::task_of(InverseClass::align_pos, *chain_);
    move.linear_velocity = *rc::gen::element(0.2, 3.0);
    move.linear_acceleration = move.rotational_velocity = move.rotational_acceleration = 2.0;
    send_move(engine_, kMoved, move);
  }

  void narrow(std::uint8_t slot) {
    JointLimits limits = robot_of(3, -0.5, 0.5).limits;
    limits.velocity.fill(2.0);
    if (*rc::gen::inRange(0, 2) == 0) limits.upper[static_cast<std::size_t>(*rc::gen::inRange(0, 3))] = hostile(0.5);
    if (*rc::gen::inRange(0, 3) == 0) limits.velocity[0] = hostile(2.0);
    limits_[slot].push_back(limits);
    send_limits(engine_, slot, limits);
  }

  // A wall through the origin, free on one side; sometimes one that no worker should tell of.
  void give_surroundings() {
    haptics::ContactModel& model = engine_.contact_inlet(0).writable();
    model = haptics::ContactModel();
    model.sequence = ++models_;
    model.posture_time = now_;
    model.slot = kInstrument;
    model.reach = 1.0;
    model.count = 1;
    model.constraints[0].a = -Eigen::Vector3d::UnitX();
    model.constraints[0].normal = -Eigen::Vector3d::UnitX();
    model.constraints[0].gap = models_ > 1 && *rc::gen::inRange(0, 60) == 0 ? hostile(0.01) : 0.0;
    engine_.contact_inlet(0).publish();
    if (*rc::gen::inRange(0, 3) == 0) give_tissue();
  }

  void give_tissue() {
    haptics::TissueForce& tissue = engine_.tissue_inlet(0).writable();
    tissue = haptics::TissueForce();
    tissue.sequence = models_;
    tissue.posture_time = now_;
    tissue.slot = kInstrument;
    tissue.contacts = 1;
    tissue.held = static_cast<std::uint32_t>(*rc::gen::inRange(0, 2));
    const bool bad = *rc::gen::inRange(0, 4) == 0;
    for (int i = 0; i < 3; ++i) {
      tissue.force_W[i] = *rc::gen::inRange(-1000, 1001) * 5e-3;
      tissue.stiffness(i, i) = *rc::gen::inRange(0, 1001);
      if (bad && *rc::gen::inRange(0, 2) == 0) tissue.force_W[i] = hostile(5);
      if (bad && *rc::gen::inRange(0, 2) == 0) tissue.torque_W[i] = hostile(0.1);
      if (bad && *rc::gen::inRange(0, 2) == 0) tissue.stiffness(i, (i + 1) % 3) = hostile(500);
      if (bad && *rc::gen::inRange(0, 4) == 0) tissue.x_ref[i] = hostile(0.02);
    }
    engine_.tissue_inlet(0).publish();
  }

  // Limits and jumps of one tick come in any order: each of the limits may have been the one that counted.
  void check_simulated(std::uint8_t slot, const RobotTickState& before, const RobotTickState& after) {
    expect_finite(after);
    for (std::size_t i = 0; i < 3; ++i) {
      const double from = before.joints[i].position;
      const double to = after.joints[i].position;
      if (to == from) continue;
      RC_ASSERT(std::ranges::any_of(limits_[slot], [&](const JointLimits& limits) {
        const bool near = at_most(to - from, limits.velocity[i] * kPeriod_s, 2 * kLimitSlack);
        if (near && within_reach(from, to, limits.lower[i], limits.upper[i])) return true;
        // It may have moved after the jump, and beyond limits that came after it.
        const double way = std::max(0.0, limits.velocity[i]) * kPeriod_s * (1 + kRateSlack) + 2 * kLimitSlack;
        const bool there = to >= limits.lower[i] - way && to <= limits.upper[i] + way;
        return jumped_[slot] && (std::isnan(way) || there);
      }));
    }
    limits_[slot].erase(limits_[slot].begin(), limits_[slot].end() - 1);
  }

  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  std::unique_ptr<Engine> held_ = std::make_unique<Engine>(watchdog_, EngineCapacity{.robots = kRobots});
  Engine& engine_ = *held_;
  TickReader& ticks_ = engine_.subscribe("test");
  std::shared_ptr<CheckingDevice> device_ = std::make_shared<CheckingDevice>();
  std::shared_ptr<const kinematics::Chain> chain_ =
      std::make_shared<const kinematics::Chain>(motion::test_arms::gantry());
  std::array<std::vector<JointLimits>, kRobots> limits_{};  // in force in this tick, the newest last
  std::array<bool, kRobots> jumped_{};
  Timestamp now_{1'000'000'000'000};
  std::uint64_t cycle_ = 0;
  std::uint64_t models_ = 0;
  std::uint32_t newest_move_ = 0;
  bool moved_ = false;
  bool touched_ = false;
};

RC_GTEST_PROP(EngineProperty, NothingHostileGetsOutOnAnyWay, ()) {
  HostileCell cell;
  for (int i = 0; i < 60; ++i) {
    const int actions = *rc::gen::inRange(0, 4);
    for (int k = 0; k < actions; ++k) cell.act();
    cell.tick_and_check();
  }
  RC_CLASSIFY(cell.moved(), "robots moved");
  RC_CLASSIFY(cell.touched(), "forces were felt");
}

}  // namespace
}  // namespace cellmirror::engine
