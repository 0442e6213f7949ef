#include "tests/unit/faults/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <utility>

#include "drivers/can/cia402/plan.hpp"
#include "drivers/can/cia402/session.hpp"
#include "drivers/can/dbc/session.hpp"
#include "drivers/dds/joint_state_router.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "drivers/rtde/rtde_session.hpp"
#include "ipc/wire/script_message.hpp"
#include "rt_core/engine/joint_gate.hpp"
#include "rt_core/haptics/sample_validator.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror::faults {

double value_of(unsigned n, Content content) {
  const double value = 0.3 * std::sin(0.01 * n * std::numbers::pi / 2);
  return content == Content::good || content == Content::corrupt ? value : value + 0.6;
}

namespace {

constexpr Nanoseconds kStale{100'000'000};
constexpr Nanoseconds kLost{1'000'000'000};
constexpr double kIncrement = 1e-6;  // rad

[[noreturn]] void give_up(const std::string& why) {
  fmt::print(stderr, "{}\n", why);
  std::abort();
}

// A mirrored robot of one joint: within +-3.3 rad, at most 3 rad/s.
class Robot final : public JointSampleSink {
 public:
  Robot() {
    engine::JointLimits limits;
    limits.lower.fill(-3.0);
    limits.upper.fill(3.0);
    gate_.add(1, JointValues{}, limits);
    PlausibilityBounds bounds;
    bounds.joints[0] = {.lower = -3.3, .upper = 3.3, .velocity = 3.0};
    bounds.plausible_after = 10;
    gate_.set_mode(engine::RobotMode::mirrored, {kStale, kLost}, 1, &bounds);
  }
  bool push(const JointSample& sample) noexcept override {
    gate_.take(sample, sample.receive_time);
    return true;
  }
  // The state where it is not fresh; before the first sample nothing.
  std::string state(Timestamp now) {
    gate_.age(now);
    const DataState state = gate_.state().state;
    return state == DataState::fresh || state == DataState::none ? std::string() : std::string(word(state));
  }

 private:
  engine::JointGate gate_;
};

CanFrame can_frame(std::uint32_t id, std::uint8_t length) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  return frame;
}

void put_increments(CanFrame& frame, std::size_t at, double value) {
  const auto raw = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value / kIncrement)));
  for (std::size_t i = 0; i < 4; ++i) frame.data[at + i] = static_cast<std::uint8_t>(raw >> 8 * i);
}

void flip(std::uint8_t& byte, unsigned bit) { byte = static_cast<std::uint8_t>(byte ^ 1U << bit); }

class Cia402Channel final : public Channel, private can::Cia402SessionOutput {
 public:
  Cia402Channel() : session_(plan(), *this) { session_.start(Timestamp{1}); }
  std::string name() const override { return "CAN, CiA 402"; }
  void receive(const Event& event) override {
    // Statusword "operation enabled", and the position.
    CanFrame frame = can_frame(0x181, 6);
    frame.data[0] = 0x37;
    frame.data[1] = 0x02;
    put_increments(frame, 2, value_of(event.n, event.content));
    if (event.content == Content::corrupt) flip(frame.data[4], 5);  // 2 rad
    session_.receive(frame, event.time);
  }
  std::string finding(Timestamp now) override {
    if (std::string state = robot_.state(now); !state.empty()) return state;
    return session_.counters().rejected + session_.counters().lost > 0 ? "counted" : "";
  }

 private:
  static can::Cia402Plan plan() {
    Cia402StreamConfig config;
    config.heartbeat_timeout = Nanoseconds(0);
    Cia402NodeConfig node;
    node.node_id = 1;
    node.joint_name = "J_1";
    node.scale = kIncrement;
    config.nodes.push_back(node);
    Diagnostics diagnostics;
    auto planned = can::plan_cia402(config, diagnostics);
    if (!planned) give_up(diagnostics.text());
    return std::move(*planned);
  }
  bool send(const CanFrame&) override { return true; }
  void sample(const JointSample& sample) override { robot_.push(sample); }
  void event(const can::Cia402Event&) override {}

  Robot robot_;
  can::Cia402Session session_;
};

constexpr const char* kDbc = "BO_ 256 Axis: 8 R\n SG_ Angle : 32|32@1- (0.000001,0) [0|0] \"rad\" M\n";

class ProtectedDbcChannel final : public Channel, private can::DbcSessionOutput {
 public:
  ProtectedDbcChannel() : session_(plan(), *this) {
    other_id_ = format_;
    flip(other_id_.data_id[0], 0);
  }
  std::string name() const override { return "CAN, DBC, E2E profile 5"; }
  void receive(const Event& event) override {
    CanFrame frame = can_frame(256, 8);
    put_increments(frame, 4, value_of(event.n, event.content));
    const bool ours = event.content == Content::good || event.content == Content::corrupt;
    can::protect(ours ? format_ : other_id_, event.n % 256U, std::span(frame.data).first(8));
    if (event.content == Content::corrupt) flip(frame.data[6], 5);
    session_.receive(frame, event.time);
  }
  std::string finding(Timestamp now) override {
    const can::DbcCounters& counters = session_.counters();
    if (counters.wrong_crc > 0) return "wrong CRC";
    if (counters.wrong_sequence > 0) return "wrong sequence";
    if (counters.repeated > 0) return "repeated";
    if (counters.lost > 0) return "lost";
    return robot_.state(now);
  }

 private:
  can::DbcPlan plan() {
    DbcStreamConfig config;
    config.signals = {{"Axis", "Angle", 0, "J_1", JointQuantity::position, 1.0, 0.0, true}};
    config.protections = {{.message = "Axis", .profile = E2eProfile::p05, .data_id = {0x1234}, .max_delta = 3}};
    Diagnostics diagnostics;
    can::Dbc dbc = can::parse_dbc(kDbc, "axis.dbc", diagnostics);
    auto planned = can::plan_dbc(config, std::move(dbc), diagnostics);
    if (!planned) give_up(diagnostics.text());
    format_ = planned->protections.at(0).format;
    return std::move(*planned);
  }
  void sample(const JointSample& sample) override { robot_.push(sample); }
  void rejected(const std::string&) override {}
  void outside(const std::string&) override {}

  Robot robot_;
  can::E2eFormat format_;
  can::E2eFormat other_id_;
  can::DbcSession session_;
};

class DdsChannel final : public Channel {
 public:
  DdsChannel() { router_.add(*feed_, robot_); }
  std::string name() const override { return "DDS, JointState"; }
  void receive(const Event& event) override {
    dds::JointState message{.name = {"joint"}, .position = {value_of(event.n, event.content)}};
    if (event.content == Content::other_address) message.name = {"joint"};
    std::vector<std::byte> bytes;
    dds::encode(message, bytes);
    if (event.content == Content::corrupt) flip_position(message.position[0], bytes);
    const bool foreign = event.content == Content::foreign;
    router_.accept(bytes, event.time, {.publisher = foreign ? 2U : 1U, .sequence = event.n + 1U, .guid = {}});
  }
  std::string finding(Timestamp now) override {
    if (std::string state = robot_.state(now); !state.empty()) return state;
    if (feed_->counters().lost > 0) return "lost";
    return feed_->counters().rejected > 0 ? "counted" : "";
  }

 private:
  // The highest bit of the exponent, found by the value's own bytes.
  static void flip_position(double value, std::vector<std::byte>& bytes) {
    std::array<std::byte, sizeof value> wanted{};
    std::memcpy(wanted.data(), &value, sizeof value);
    const auto at = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    if (at == bytes.end()) give_up("the position is not in the message");
    *(at + 7) ^= std::byte{0x40};
  }

  Robot robot_;
  std::unique_ptr<dds::RobotFeed> feed_ = dds::RobotFeed::make({{"joint", 0, 1.0, 0.0}}).value();
  dds::JointStateRouter router_;
};

class RtdeChannel final : public Channel, private rtde::SessionOutput {
 public:
  RtdeChannel() : session_(config(), *this) {
    session_.begin(Timestamp{1});
    receive_bytes(rtde::accepted(rtde::PackageType::version, true), Timestamp{1});
    receive_bytes(rtde::outputs_answer({.recipe = kRecipe, .types = std::string(rtde::kAllVariableTypes)}),
                  Timestamp{1});
    receive_bytes(rtde::accepted(rtde::PackageType::start, true), Timestamp{1});
  }
  std::string name() const override { return "RTDE"; }
  void receive(const Event& event) override {
    constexpr double kPeriod_s = 0.01;
    rtde::RobotData data{.timestamp_s = 1.0 + kPeriod_s * event.n};
    data.has_all = true;
    data.q[0] = value_of(event.n, event.content);
    rtde::Bytes bytes = rtde::data_package(data, kRecipe);
    constexpr std::size_t kPosition = 3 + 1 + 8;                         // behind head, recipe and time
    if (event.content == Content::corrupt) bytes.at(kPosition) ^= 0x40;  // the highest bit of the exponent
    receive_bytes(bytes, event.time);
  }
  std::string finding(Timestamp now) override {
    if (std::string state = robot_.state(now); !state.empty()) return state;
    if (session_.counters().lost > 0) return "lost";
    return session_.counters().rejected > 0 ? "refused" : "";
  }

 private:
  static constexpr std::uint8_t kRecipe = 1;
  static RtdeStreamConfig config() {
    RtdeStreamConfig config;
    config.rate_hz = 100;
    config.joints.push_back({.joint = 0, .number = 0});
    return config;
  }
  void receive_bytes(const rtde::Bytes& bytes, Timestamp now) { session_.receive(bytes, now); }
  void send(std::span<const std::uint8_t>) override {}
  void sample(const JointSample& sample) override { robot_.push(sample); }
  void rejected(const std::string&) override {}
  void message(const std::string&) override {}

  Robot robot_;
  rtde::RtdeSession session_;
};

class ScriptChannel final : public Channel {
 public:
  std::string name() const override { return "System V queue, SCRIPT"; }
  void receive(const Event& event) override {
    std::string text =
        script_message_text(7, fmt::format("POS_ROB R JOINT_ABS {:.6f}", value_of(event.n, event.content)));
    if (event.content == Content::corrupt) text.back() = static_cast<char>(text.back() ^ 0x02);  // another digit
    refused_ += parse_script_message(text).text ? 0 : 1;
  }
  std::string finding(Timestamp) override { return refused_ > 0 ? "refused" : ""; }

 private:
  int refused_ = 0;
};

class HapticMemoryChannel final : public Channel {
 public:
  HapticMemoryChannel() { validator_.restart(Timestamp{1}); }
  std::string name() const override { return "shared memory, haptic device"; }
  void receive(const Event& event) override {
    HapticSample sample;
    sample.sequence = event.n + 1U;
    sample.writes = ++writes_;
    sample.time = event.time;
    sample.writer = event.content == Content::foreign ? 2 : 1;
    sample.valid = true;
    // A decimetre a radian.
    sample.p_DH.x() = 0.1 * value_of(event.n, event.content);
    if (event.content == Content::corrupt) sample.p_DH.x() *= -1e12;
    validate(HapticRead::fresh, sample, event.time);
  }
  std::string finding(Timestamp now) override {
    if (fault_.empty()) validate(HapticRead::unchanged, {}, now);
    if (!fault_.empty()) return fault_;
    return validator_.skipped() > 0 ? "lost" : "";
  }

 private:
  void validate(HapticRead read, const HapticSample& sample, Timestamp now) {
    const haptics::SampleLimits limits{.uses_pose = false, .stale_after = kStale, .max_speed = 3.0};
    const haptics::Verdict verdict = validator_.validate(read, sample, now, limits);
    HapticFault fault = verdict.fault;
    if (verdict.fresh) fault = validator_.moved_to(sample.p_DH, limits);
    if (fault != HapticFault::none && fault_.empty()) fault_ = word(fault);
  }

  haptics::SampleValidator validator_;
  std::uint64_t writes_ = 0;
  std::string fault_;
};

}  // namespace

std::unique_ptr<Channel> make_cia402_channel() { return std::make_unique<Cia402Channel>(); }
std::unique_ptr<Channel> make_protected_dbc_channel() { return std::make_unique<ProtectedDbcChannel>(); }
std::unique_ptr<Channel> make_dds_channel() { return std::make_unique<DdsChannel>(); }
std::unique_ptr<Channel> make_rtde_channel() { return std::make_unique<RtdeChannel>(); }
std::unique_ptr<Channel> make_script_channel() { return std::make_unique<ScriptChannel>(); }
std::unique_ptr<Channel> make_haptic_channel() { return std::make_unique<HapticMemoryChannel>(); }

}  // namespace cellmirror::faults
