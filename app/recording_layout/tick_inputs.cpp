#include "app/recording_layout/tick_inputs.hpp"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/state_transfer.hpp"

namespace cellmirror::app {

namespace {

using engine::InputRecord;
using engine::TickPart;

static_assert(std::tuple_size_v<decltype(PublishedRobots::Robot::parts)> == kRobotStateParts);

constexpr Nanoseconds kLongestPeriod{1'000'000'000};
constexpr std::uint64_t kMostMissed = std::uint64_t{1} << 40;

Error not_sound(std::string_view what) {
  return {fmt::format("the recorded inputs are not sound: {}", what), "check the file: recording check"};
}

JointSample read_sample(StateReader& in) {
  std::size_t joints = 0;
  JointSample sample;
  in.bounded(joints, kMaxJointsPerRobot);
  if (in.ok()) transfer_sample(in, sample, joints);
  return sample;
}

TakenHaptic read_haptic(StateReader& in) {
  TakenHaptic out;
  bool has_sample = false;
  bool has_model = false;
  bool has_tissue = false;
  bool has_moved = false;
  in(out.channel, out.slot);
  in.choice(out.outcome, HapticRead::none);
  in(has_sample, has_model, has_tissue, has_moved);
  if (out.channel >= kMaxHapticDevices || has_sample != (out.outcome == HapticRead::fresh)) in.fail();
  if (!in.ok()) return out;
  if (has_sample) in(out.sample.emplace());
  if (has_model) in(out.model.emplace());
  if (has_tissue) in(out.tissue.emplace());
  if (has_moved) out.moved = read_sample(in);
  return out;
}

bool is_sound(const CycleContext& context) {
  return context.now.known() && context.now.ns > 0 && context.now < kLatestInstant && context.scheduled.ns >= 0 &&
         context.missed < kMostMissed && context.period.count() > 0 && context.period <= kLongestPeriod &&
         context.last_compute.count() >= 0;
}

}  // namespace

void PublishedRobots::read(StateReader& in) {
  std::uint8_t slot = 0;
  std::uint16_t mask = 0;
  in(slot, mask);
  if (!in.ok() || slot >= robots_.size() || mask >> kRobotStateParts != 0) return in.fail();
  Robot& robot = robots_[slot];
  for (std::size_t i = 0; i < kRobotStateParts && in.ok(); ++i) {
    if ((mask >> i & 1U) == 0) continue;
    const ByteSpan before = in.rest();
    transfer_part(in, robot.state, i);
    const std::size_t size = before.size() - in.rest().size();
    if (!in.ok() || size > sizeof(robot.parts[i].bytes)) return in.fail();
    robot.parts[i].size = static_cast<std::uint16_t>(size);
    std::memcpy(robot.parts[i].bytes, before.data(), size);
  }
}

Result<TickInputs> read_tick(ByteSpan record, PublishedRobots& robots) {
  StateReader in(record);
  TickInputs out;
  CycleContext& context = out.context;
  in(context.cycle, context.now, context.scheduled, context.missed, context.period, context.last_compute,
     out.commands_done, out.commands_refused);
  if (!in.ok() || !is_sound(context)) return std::unexpected(not_sound("the head of a tick"));
  for (bool more = true; more && in.ok();) {
    std::uint8_t part = 0;
    in(part);
    if (!in.ok()) break;
    switch (static_cast<TickPart>(part)) {
      case TickPart::end:
        more = false;
        break;
      case TickPart::sample: {
        TakenSample& taken = out.samples.emplace_back();
        in(taken.slot);
        taken.sample = read_sample(in);
        break;
      }
      case TickPart::haptic:
        out.haptics.push_back(read_haptic(in));
        break;
      case TickPart::robot:
        robots.read(in);
        break;
      case TickPart::haptic_state: {
        PublishedHaptic& published = out.haptic_states.emplace_back();
        in(published.channel, published.state);
        if (published.channel >= kMaxHapticDevices) in.fail();
        break;
      }
      default:
        in.fail();
    }
  }
  if (!in.ok() || !in.at_end()) return std::unexpected(not_sound(fmt::format("tick {}", context.cycle)));
  return out;
}

std::vector<std::byte> names_record(const NamesBySlot& names) {
  std::vector<std::byte> buffer(std::size_t{2} << 20);
  StateWriter out(buffer);
  std::size_t count = names.size();
  out.bounded(count, kMaxRobots);
  for (const auto& [slot, robot] : names) {
    std::uint8_t number = slot;
    std::size_t joints = robot.joints.size();
    out(number);
    out.text(robot.robot);
    out.bounded(joints, kMaxJointsPerRobot);
    for (const std::string& joint : robot.joints) out.text(joint);
  }
  buffer.resize(out.ok() ? out.size() : 0);
  return buffer;
}

Result<NamesBySlot> read_names(ByteSpan record) {
  StateReader in(record);
  NamesBySlot out;
  std::size_t count = 0;
  in.bounded(count, kMaxRobots);
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    std::uint8_t slot = 0;
    std::size_t joints = 0;
    in(slot);
    RobotNames& names = out[slot];
    in.text(names.robot);
    in.bounded(joints, kMaxJointsPerRobot);
    if (!in.ok()) break;
    names.joints.resize(joints);
    for (std::string& joint : names.joints) in.text(joint);
  }
  if (!in.ok() || !in.at_end()) return std::unexpected(not_sound("the names of robots"));
  return out;
}

Result<void> for_each_record(ByteSpan message, const std::function<bool(InputRecord, ByteSpan)>& take) {
  if (message.empty() || static_cast<std::uint8_t>(message.front()) != engine::kInputsVersion)
    return fail("the recorded inputs are of another version", "use the program that recorded them");
  StateReader in(message.subspan(1));
  while (in.ok() && !in.at_end()) {
    std::uint8_t kind = 0;
    std::uint32_t length = 0;
    in(kind, length);
    const ByteSpan rest = in.rest();
    in.skip(length);
    if (in.ok() && !take(static_cast<InputRecord>(kind), rest.first(length))) return {};
  }
  if (!in.ok()) return std::unexpected(not_sound("the length of a record"));
  return {};
}

}  // namespace cellmirror::app
