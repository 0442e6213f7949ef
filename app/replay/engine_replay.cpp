#include "app/replay/engine_replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "app/replay/recorded_device.hpp"
#include "app/replay/state_text.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/instrument_bytes.hpp"
#include "rt_core/engine/state_transfer.hpp"
#include "rt_core/engine/trajectory_bytes.hpp"
#include "rt_core/rt/watchdog.hpp"

namespace cellmirror::app {

namespace {

using engine::InputRecord;

constexpr std::chrono::milliseconds kNeverWatched{100};
constexpr std::size_t kMostCommandsKept = 100'000;
constexpr std::size_t kMostChains = 100'000;
constexpr std::size_t kMostTrajectories = kMaxRobots;  // that run at one time

}  // namespace

struct EngineReplay::Session {
  explicit Session(const engine::EngineCapacity& capacity)
      : engine(watchdog, capacity), ticks(engine.subscribe("replay")), published(capacity.robots) {}

  Watchdog watchdog{kNeverWatched, {}};
  engine::Engine engine;
  engine::TickReader& ticks;
  PublishedRobots published;
  std::optional<std::uint64_t> last_tick;
  std::uint64_t commands_done = 0;
  std::array<std::uint64_t, kMaxHapticDevices> devices{};  // ids of devices
  std::array<bool, kMaxHapticDevices> taken_over{};        // open at the start state, which does not have its state
  bool counts_refused = true;                              // whether refused commands can be compared
  std::array<std::shared_ptr<RecordedDevice>, kMaxHapticDevices> recorded_devices{};
};

EngineReplay::EngineReplay() = default;
EngineReplay::~EngineReplay() = default;

void EngineReplay::note(const Error& error) {
  ++counts_.not_sound;
  if (counts_.first_problem.empty()) counts_.first_problem = error.text();
  session_.reset();
}

void EngineReplay::gap(const std::string& why) {
  if (!session_) return;
  ++counts_.gaps;
  if (counts_.first_problem.empty()) counts_.first_problem = why;
  session_.reset();
}

void EngineReplay::take(ByteSpan message) {
  const auto read = for_each_record(message, [this](InputRecord kind, ByteSpan content) {
    take_record(kind, content);
    return !difference_.has_value();
  });
  if (!read) note(read.error());
}

void EngineReplay::take_record(InputRecord kind, ByteSpan content) {
  switch (kind) {
    case InputRecord::command: {
      StateReader in(content);
      std::uint64_t id = 0;
      in(id);
      if (!in.ok() || commands_.size() >= kMostCommandsKept) return note({"a command is not sound", {}});
      commands_[id].assign(in.rest().begin(), in.rest().end());
      return;
    }
    case InputRecord::chain:
      return take_chain(content);
    case InputRecord::trajectory:
      return take_trajectory(content);
    case InputRecord::robots:
      if (auto names = read_names(content)) {
        names_ = *std::move(names);
      } else {
        note(names.error());
      }
      return;
    case InputRecord::start:
      return begin(content);
    case InputRecord::tick:
      return run(content);
  }
  note({"a record is of an unknown kind", {}});
}

EngineReplay::ChainPtr EngineReplay::chain_of(std::uint64_t object_id, kinematics::Chain&& chain, ByteSpan bytes) {
  KnownChain& known = chains_[object_id];
  if (known.chain && std::ranges::equal(known.bytes, bytes)) return known.chain;
  known.bytes.assign(bytes.begin(), bytes.end());
  known.chain = std::make_shared<const kinematics::Chain>(std::move(chain));
  all_chains_.push_back(known.chain);
  return known.chain;
}

void EngineReplay::take_chain(ByteSpan content) {
  StateReader in(content);
  std::uint64_t object_id = 0;
  in(object_id);
  const ByteSpan bytes = in.rest();
  auto chain = engine::read_chain(in);
  if (!chain || !in.at_end() || all_chains_.size() >= kMostChains) return note({"a chain of joints is not sound", {}});
  chain_of(object_id, *std::move(chain), bytes);
}

// Only a start state that comes behind them refers to them.
void EngineReplay::take_trajectory(ByteSpan content) {
  StateReader in(content);
  std::uint64_t object_id = 0;
  in(object_id);
  auto trajectory = engine::read_trajectory(in);
  if (!trajectory || !in.at_end()) return note({"a trajectory is not sound", {}});
  // Those before it are of start states that are over, or that were not needed.
  if (trajectories_.size() >= kMostTrajectories) trajectories_.erase(trajectories_.begin());
  trajectories_[object_id] = std::make_shared<const motion::Trajectory>(*std::move(trajectory));
}

// While the replay goes on it is right already, unless the next tick shows that some are missing.
void EngineReplay::begin(ByteSpan start) {
  if (session_) return spare_start_.assign(start.begin(), start.end());
  const auto capacity = engine::Engine::capacity_of(start);
  if (!capacity) return note(capacity.error());
  auto session = std::make_unique<Session>(*capacity);
  const auto restored = session->engine.restore(
      start, {.chain = [this](std::uint64_t object_id) -> ChainPtr {
                const auto known = chains_.find(object_id);
                return known == chains_.end() ? ChainPtr() : known->second.chain;
              },
              .trajectory = [this](std::uint64_t object_id) -> std::shared_ptr<const motion::Trajectory> {
                const auto known = trajectories_.find(object_id);
                return known == trajectories_.end() ? nullptr : known->second;
              },
              .device = [&](std::size_t channel, std::uint64_t /*id*/) -> std::shared_ptr<HapticDevicePort> {
                session->recorded_devices[channel] = std::make_shared<RecordedDevice>();
                return session->recorded_devices[channel];
              }});
  if (!restored) return note(restored.error());
  session->commands_done = restored->commands_done;
  session->devices = restored->open_devices;
  for (std::size_t i = 0; i < kMaxHapticDevices; ++i) {
    session->taken_over[i] = session->devices[i] != 0 && !restored->restored[i];
    if (!session->taken_over[i]) continue;
    session->counts_refused = false;
    if (std::ranges::find(taken_over_, i) == taken_over_.end()) taken_over_.push_back(static_cast<std::uint8_t>(i));
  }
  std::erase_if(commands_, [&](const auto& command) { return command.first <= restored->commands_done; });
  ++counts_.starts;
  session_ = std::move(session);
}

Result<void> EngineReplay::send_commands(std::uint64_t up_to) {
  Session& session = *session_;
  if (up_to < session.commands_done || up_to - session.commands_done > engine::kCommandsPerTick)
    return fail("the numbers of commands are not sound");
  for (std::uint64_t id = session.commands_done + 1; id <= up_to; ++id) {
    const auto bytes = commands_.find(id);
    if (bytes == commands_.end()) return fail(fmt::format("command {} is missing", id));
    std::uint64_t device = 0;
    StateReader in(bytes->second);
    auto command = engine::read_command(
        in, {.engine = session.engine,
             .chain = [&](std::uint64_t object_id, kinematics::Chain&& chain) -> ChainPtr {
               std::vector<std::byte> encoded(std::size_t{64} << 10);
               StateWriter out(encoded);
               engine::write_chain(out, chain);
               return chain_of(object_id, std::move(chain), out.written());
             },
             .device = [&](std::uint8_t channel, std::uint64_t object_id) -> std::shared_ptr<HapticDevicePort> {
               device = object_id;
               if (channel >= kMaxHapticDevices) return nullptr;
               // Another device is another object: the channel distinguishes them by that.
               auto& recorded = session.recorded_devices[channel];
               if (!recorded || session.devices[channel] != object_id) recorded = std::make_shared<RecordedDevice>();
               return recorded;
             }});
    if (!command) return fail(fmt::format("command {} is not sound", id));
    if (auto* const of_haptics = std::get_if<engine::HapticCommand>(&*command)) {
      if (const auto* open = std::get_if<engine::OpenHaptic>(of_haptics);
          open != nullptr && open->channel < kMaxHapticDevices) {
        const std::uint8_t channel = open->channel;
        const bool same = session.taken_over[channel] && session.devices[channel] == device;
        session.devices[channel] = device;
        if (same) {
          *command = engine::HapticCommand(engine::CloseHaptic{channel});  // of a channel that is closed here
        } else {
          session.taken_over[channel] = false;
        }
      } else if (const auto* close = std::get_if<engine::CloseHaptic>(of_haptics);
                 close != nullptr && close->channel < kMaxHapticDevices) {
        session.taken_over[close->channel] = false;
        session.devices[close->channel] = 0;
      }
    }
    if (session.engine.send(*command) != id) return fail(fmt::format("command {} cannot be sent", id));
    commands_.erase(bytes);
  }
  session.commands_done = up_to;
  return {};
}

Result<void> EngineReplay::give(const TickInputs& inputs) {
  Session& session = *session_;
  const auto push = [&](std::uint8_t slot, const JointSample& sample) {
    return slot < session.engine.capacity().robots && session.engine.inlet(slot).push(sample);
  };
  for (const TakenSample& taken : inputs.samples)
    if (!push(taken.slot, taken.sample)) return fail("a sample cannot be given to its robot");
  for (auto& device : session.recorded_devices)
    if (device) device->outcome = HapticRead::unchanged;
  for (const TakenHaptic& taken : inputs.haptics) {
    if (taken.channel >= session.engine.capacity().haptic_devices) return fail("there is no such haptic channel");
    if (session.taken_over[taken.channel]) {
      // Of others nothing is taken from the inlet.
      const auto& robots = session.published.robots();
      const bool mirrored = taken.slot < robots.size() && robots[taken.slot].state.mode == engine::RobotMode::mirrored;
      if (mirrored && taken.moved && !push(taken.slot, *taken.moved))
        return fail("a sample cannot be given to its robot");
      continue;
    }
    if (const auto& device = session.recorded_devices[taken.channel]) {
      device->outcome = taken.outcome;
      if (taken.sample) device->recorded = *taken.sample;
    }
    if (taken.model) {
      auto& inlet = session.engine.contact_inlet(taken.channel);
      inlet.writable() = *taken.model;
      inlet.publish();
    }
    if (taken.tissue) {
      auto& inlet = session.engine.tissue_inlet(taken.channel);
      inlet.writable() = *taken.tissue;
      inlet.publish();
    }
  }
  return {};
}

void EngineReplay::begin_again_after_a_gap(ByteSpan record) {
  std::uint64_t tick = 0;
  StateReader in(record);
  in(tick);
  if (session_ && session_->last_tick && in.ok() && tick != *session_->last_tick + 1) {
    gap(fmt::format("ticks are missing before tick {}", tick));
    if (!spare_start_.empty()) begin(std::exchange(spare_start_, {}));
  }
  spare_start_.clear();
}

void EngineReplay::run(ByteSpan record) {
  begin_again_after_a_gap(record);
  if (!session_) {
    ++counts_.skipped;
    return;
  }
  Session& session = *session_;
  const auto inputs = read_tick(record, session.published);
  if (!inputs) return note(inputs.error());
  const std::uint64_t tick = inputs->context.cycle;
  session.last_tick = tick;
  Result<void> step = send_commands(inputs->commands_done);
  if (step) step = give(*inputs);
  if (!step) {
    ++counts_.skipped;
    return gap(fmt::format("tick {}: {}", tick, step.error().text()));
  }
  session.engine.run(inputs->context);
  session.engine.free_returned();
  ++counts_.ticks;
  counts_.recorded_s += seconds(inputs->context.period) * (1.0 + static_cast<double>(inputs->context.missed));
  compare(*inputs);
  if (on_tick_) on_tick_(session.ticks.newest());
}

void EngineReplay::compare(const TickInputs& inputs) {
  const engine::TickState& computed = session_->ticks.newest();
  for (std::size_t slot = 0; slot < computed.robots.size(); ++slot)
    if (!compare_robot(inputs, slot)) return;
  compare_haptics(inputs);
  if (difference_ || !session_->counts_refused || computed.commands_refused == inputs.commands_refused) return;
  difference_ = {.tick = computed.tick,
                 .time = computed.time,
                 .robot = {},
                 .joint = {},
                 .what = "refused commands",
                 .recorded = std::to_string(inputs.commands_refused),
                 .computed = std::to_string(computed.commands_refused)};
}

ReplayDifference EngineReplay::difference_in(const TickInputs& inputs, std::size_t slot, std::string what) const {
  ReplayDifference out{.tick = inputs.context.cycle,
                       .time = inputs.context.now,
                       .robot = {},
                       .joint = {},
                       .what = std::move(what),
                       .recorded = {},
                       .computed = {}};
  const auto known = names_.find(static_cast<std::uint8_t>(slot));
  out.robot = known == names_.end() ? fmt::format("slot {}", slot) : known->second.robot;
  return out;
}

bool EngineReplay::compare_robot(const TickInputs& inputs, std::size_t slot) {
  const PublishedRobots::Robot& recorded = session_->published.robots()[slot];
  const engine::RobotTickState& computed = session_->ticks.newest().robots[slot];
  const bool used = recorded.state.mode != engine::RobotMode::absent;
  if (!used && computed.mode == engine::RobotMode::absent) return true;
  std::array<std::byte, kMostPartBytes> buffer;
  for (std::size_t part = 0; part < (used ? kRobotStateParts : 1); ++part) {
    StateWriter out(buffer);
    session_->engine.write_published(out, slot, part);
    const engine::InputTap::PublishedPart& wanted = recorded.parts[part];
    if (out.size() == wanted.size && std::memcmp(wanted.bytes, buffer.data(), wanted.size) == 0) continue;
    difference_ = difference_in(inputs, slot, std::string(part_name(part)));
    const bool of_joint = part >= kRobotHeadParts && wanted.size == out.size() && computed.joint_count > 0;
    std::size_t joint = 0;
    if (of_joint) {
      const std::size_t size = wanted.size / computed.joint_count;
      while (std::memcmp(wanted.bytes + joint * size, buffer.data() + joint * size, size) == 0) ++joint;
      const auto known = names_.find(static_cast<std::uint8_t>(slot));
      difference_->joint = known != names_.end() && joint < known->second.joints.size()
                               ? known->second.joints[joint]
                               : fmt::format("joint {}", joint);
    }
    difference_->recorded = part_text(recorded.state, part, joint);
    difference_->computed = part_text(computed, part, joint);
    return false;
  }
  return true;
}

void EngineReplay::compare_haptics(const TickInputs& inputs) {
  std::array<std::byte, 2048> recorded;
  std::array<std::byte, 2048> computed;
  for (const PublishedHaptic& published : inputs.haptic_states) {
    if (published.channel >= session_->engine.capacity().haptic_devices) continue;
    if (session_->taken_over[published.channel]) continue;
    HapticState here = session_->engine.haptic_state(published.channel);
    if (here.phase == HapticPhase::closed) here = HapticState{};
    HapticState there = published.state;
    StateWriter a(recorded);
    StateWriter b(computed);
    a(there);
    b(here);
    if (std::ranges::equal(a.written(), b.written())) continue;
    difference_ = difference_in(inputs, here.slot, fmt::format("haptic device {}", published.channel));
    difference_->recorded = haptic_text(there);
    difference_->computed = haptic_text(here);
    return;
  }
}

}  // namespace cellmirror::app
