// replay_corpus FOLDER: writes the corpus of replay_fuzz, messages of small engines, and replays each. The same bytes
// each time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/replay/engine_replay.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/input_tap.hpp"
#include "rt_core/haptics/instrument.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/rt/watchdog.hpp"
#include "tests/unit/engine/commands.hpp"

namespace {

using namespace cellmirror;

constexpr Nanoseconds kPeriod{2'000'000};

kinematics::Chain slides() {
  std::vector<kinematics::Variable> variables;
  for (const char* name : {"X", "Y", "Z"}) variables.push_back({name, JointKind::prismatic, -1.0, 1.0});
  Pose turn = Pose::Identity();
  turn.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y, y to z, z to x
  std::vector<kinematics::ChainJoint> joints(3);
  for (std::uint8_t i = 0; i < 3; ++i) joints[i] = {.X_PJ = turn, .kind = JointKind::prismatic, .variable = i};
  return *kinematics::Chain::make(variables, joints, Pose::Identity());
}

class Hand final : public HapticDevicePort {
 public:
  HapticRead read(HapticSample& out) CELL_RT override {
    if (++reads_ % 3 == 0) return HapticRead::unchanged;
    out = HapticSample();
    out.sequence = reads_;
    out.time = *now;
    out.valid = true;
    out.writer = 1;
    return HapticRead::fresh;
  }
  void write(const HapticOutput& /*output*/) CELL_RT override {}
  const Timestamp* now = nullptr;

 private:
  std::uint64_t reads_ = 0;
};

// Robots of three joints in an engine that has a start state recorded from its first tick on.
class Sample {
 public:
  explicit Sample(std::size_t robots) : engine_(watchdog_, {.robots = robots}) {
    for (std::size_t slot = 0; slot < robots; ++slot) engine::send_robot(engine_, slot, engine::robot_of(3, -2, 2));
    engine_.send(engine::SetChain{.slot = 0, .chain = engine_.lend(chain_)});
    tick(2);
  }

  void begin() { engine_.inputs().request_start(); }
  void tick(int times) { engine::run_cycles(engine_, now_, cycle_, times, kPeriod); }
  void move(motion::MoveKind kind, double to) {
    motion::Move one;
    one.kind = kind;
    one.start = motion::Start::queue;
    one.id = ++moves_;
    one.max_velocity.fill(3);
    one.velocity.fill(1);
    one.acceleration.fill(4);
    one.target.fill(to);
    one.X_BG.translation() = Eigen::Vector3d(to, 0.1, 0.2);
    one.linear_velocity = one.rotational_velocity = 0.5;
    one.linear_acceleration = one.rotational_acceleration = 2;
    engine::send_move(engine_, 0, one);
  }
  void mirror(std::size_t slot) {
    engine_.send(engine::SetMode{.slot = engine::slot_number(slot), .mode = engine::RobotMode::mirrored});
  }
  void sample(std::size_t slot, double position) {
    JointSample one;
    one.receive_time = now_;
    one.sequence = ++samples_;
    one.present = 7;
    for (std::size_t j = 0; j < 3; ++j) one.position[j] = position;
    engine_.inlet(slot).push(one);
  }
  void open_hand() {
    auto hand = std::make_shared<Hand>();
    hand->now = &now_;
    haptics::Instrument instrument{.slot = 0, .joint_count = 3, .chain = slides(), .settings = {}};
    for (std::uint8_t i = 0; i < 3; ++i) instrument.variable_joint[i] = i;
    instrument.lower.fill(-1);
    instrument.upper.fill(1);
    mirror(0);
    engine_.send(engine::OpenHaptic{
        .channel = 0,
        .instrument = engine_.lend(std::make_shared<const haptics::Instrument>(std::move(instrument))),
        .device = engine_.lend<HapticDevicePort>(std::move(hand))});
  }
  void give_model() {
    haptics::ContactModel& model = engine_.contact_inlet(0).writable();
    model = haptics::ContactModel();
    model.sequence = ++models_;
    model.posture_time = now_;
    model.reach = 1;
    model.count = 1;
    model.constraints[0].a = model.constraints[0].normal = -Eigen::Vector3d::UnitX();
    model.constraints[0].gap = 0.01;
    engine_.contact_inlet(0).publish();
  }
  engine::Engine& engine() { return engine_; }
  std::vector<std::byte> message() {
    std::vector<std::byte> out{std::byte{engine::kInputsVersion}};
    engine_.inputs().drain(out);
    return out;
  }

 private:
  Watchdog watchdog_{std::chrono::milliseconds(100), {}};
  engine::Engine engine_;
  std::shared_ptr<const kinematics::Chain> chain_ = std::make_shared<const kinematics::Chain>(slides());
  Timestamp now_{1'000'000'000};
  std::uint64_t cycle_ = 0;
  std::uint32_t moves_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t models_ = 0;
};

std::vector<std::byte> still() {
  Sample sample(1);
  sample.begin();
  sample.tick(3);
  return sample.message();
}

// In the middle of a path, with a move that waits.
std::vector<std::byte> moving() {
  Sample sample(1);
  sample.move(motion::MoveKind::linear, 0.4);
  sample.move(motion::MoveKind::joints, -0.4);
  sample.tick(60);
  sample.begin();
  sample.tick(3);
  return sample.message();
}

std::vector<std::byte> mirrored() {
  Sample sample(2);
  engine::Coupling coupling;
  coupling.master = 0;
  coupling.slave = 1;
  coupling.count = 1;
  coupling.max_velocity.fill(1);
  engine::send_coupling(sample.engine(), coupling);
  sample.mirror(0);
  sample.begin();
  for (int i = 0; i < 3; ++i) {
    sample.sample(0, 0.01 * i);
    sample.tick(1);
  }
  return sample.message();
}

// Commands of each kind while it records.
std::vector<std::byte> commands() {
  Sample sample(2);
  sample.begin();
  sample.move(motion::MoveKind::joints, 0.5);
  engine::Engine& engine = sample.engine();
  engine.send(engine::SetPace{.slot = 0, .pace = 0.5});
  engine.send(engine::SetPositions{.slot = 1, .positions = {0.1, 0.2, 0.3}});
  engine::send_limits(engine, 1, engine::robot_of(3, -1, 1).limits);
  sample.tick(2);
  engine.send(engine::StopMotion{.slot = 0});
  engine.send(engine::RemoveRobot{.slot = 1});
  sample.tick(1);
  return sample.message();
}

std::vector<std::byte> haptic() {
  Sample sample(1);
  sample.begin();
  sample.open_hand();
  for (int i = 0; i < 4; ++i) {
    sample.give_model();
    sample.tick(1);
  }
  return sample.message();
}

// Open before the recording begins: its state is in the start state.
std::vector<std::byte> open_haptic() {
  Sample sample(1);
  sample.open_hand();
  for (int i = 0; i < 6; ++i) {
    if (i == 4) sample.begin();
    sample.give_model();
    sample.tick(1);
  }
  return sample.message();
}

// Ticks that are missing, and another start state.
std::vector<std::byte> gap() {
  Sample sample(1);
  sample.begin();
  sample.tick(2);
  std::vector<std::byte> out = sample.message();
  sample.tick(2);
  static_cast<void>(sample.message());
  sample.begin();
  sample.tick(2);
  const std::vector<std::byte> behind = sample.message();
  out.insert(out.end(), behind.begin() + 1, behind.end());
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: replay_corpus FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  const std::pair<const char*, std::vector<std::byte> (*)()> seeds[] = {
      {"still", still},   {"moving", moving}, {"mirrored", mirrored},      {"commands", commands},
      {"haptic", haptic}, {"gap", gap},       {"open_haptic", open_haptic}};
  for (const auto& [name, make] : seeds) {
    const std::vector<std::byte> bytes = make();
    app::EngineReplay replay;
    replay.take(bytes);
    std::printf("%s: %zu bytes, %llu ticks\n", name, bytes.size(),
                static_cast<unsigned long long>(replay.counts().ticks));
    if (replay.difference() || replay.counts().not_sound > 0 || replay.counts().ticks == 0) return 1;
    std::ofstream file(folder / (std::string(name) + ".bin"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) return 1;
  }
  return 0;
}
