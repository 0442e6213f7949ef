// The state of the engine between two ticks as bytes, and back. Beginning of a recording of its inputs.
//
// A start state: robots and channels of the engine's capacity; periods missed, commands done and refused; the ids
// of the devices of open haptic channels; used slots with their state; couplings; open haptic channels: number,
// state. Recordings of versions before that end behind the couplings: of those a replay takes what such a channel gave
// until it is opened again. Where robots have followed trajectories: kMaxHapticDevices, the number of those robots, and
// of each its slot and state.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "rt_core/engine/engine.hpp"
#include "rt_core/engine/state_transfer.hpp"

namespace cellmirror::engine {

namespace {

template <class Archive>
void transfer_capacity(Archive& archive, EngineCapacity& capacity) CELL_RT {
  archive.bounded(capacity.robots, kMaxRobots);
  archive.bounded(capacity.haptic_devices, kMaxHapticDevices);
}

Error not_sound(std::string_view what) {
  return {fmt::format("the recorded state of the engine is not sound: {}", what), "check the file: recording check"};
}

}  // namespace

void Engine::write_start(StateWriter& out) CELL_RT {
  EngineCapacity capacity = capacity_;
  transfer_capacity(out, capacity);
  out(head_.missed_periods, head_.commands_done, head_.commands_refused);
  for (std::size_t channel = 0; channel < kMaxHapticDevices; ++channel) {
    const bool open = channel < haptics_.size() && haptics_.used(channel);
    const HapticDevicePort* device = open ? haptics_.device(channel) : nullptr;
    out.reference(device);
  }
  std::size_t used = 0;
  for (const RobotSlot& slot : slots_) used += slot.used() ? 1 : 0;
  out.bounded(used, kMaxRobots);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].used()) continue;
    std::size_t number = i;
    out.bounded(number, kMaxRobots);
    slots_[i].write(out);
  }
  std::size_t couplings = 0;
  for (const Coupling& coupling : couplings_.all()) couplings += coupling.count > 0 ? 1 : 0;
  out.bounded(couplings, kMaxRobots);
  for (Coupling& coupling : couplings_.all()) {
    if (coupling.count > 0) out(coupling);
  }
  for (std::size_t channel = 0; channel < haptics_.size(); ++channel) {
    if (!haptics_.used(channel)) continue;
    std::size_t number = channel;
    out.bounded(number, kMaxHapticDevices);
    haptics_.write(channel, out);
  }
  std::size_t followers = 0;
  for (const RobotSlot& slot : slots_) followers += slot.used() && slot.has_trajectory() ? 1 : 0;
  if (followers == 0) return;
  std::size_t mark = kMaxHapticDevices;
  out.bounded(mark, kMaxHapticDevices);
  out.bounded(followers, kMaxRobots);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].used() || !slots_[i].has_trajectory()) continue;
    std::size_t number = i;
    out.bounded(number, kMaxRobots);
    slots_[i].write_trajectory(out);
  }
}

void Engine::record_published() CELL_RT {
  for (std::size_t i = 0; i < slots_.size(); ++i) recorder_.robot(i, slots_[i]);
  for (std::size_t i = 0; i < haptics_.size(); ++i) recorder_.haptic_state(i, haptics_.state(i));
  recorder_.end();
}

void Engine::write_published(StateWriter& out, std::size_t slot, std::size_t part) {
  slots_[slot].transfer_published(out, part);
}

Result<EngineCapacity> Engine::capacity_of(std::span<const std::byte> start) {
  StateReader in(start);
  EngineCapacity capacity;
  transfer_capacity(in, capacity);
  if (!in.ok()) return std::unexpected(not_sound("it is cut"));
  return capacity;
}

// To the end of the record.
Result<void> Engine::restore_trajectories(std::span<const std::byte> tail, const StartParts& parts) {
  std::shared_ptr<const motion::Trajectory> found;  // of the robot that is read
  StateReader in(tail, [&](std::uint64_t id) -> const void* {
    found = parts.trajectory ? parts.trajectory(id) : nullptr;
    return found.get();
  });
  std::size_t count = 0;
  in.bounded(count, slots_.size());
  for (std::size_t i = 0; i < count && in.ok(); ++i) {
    std::size_t number = 0;
    in.bounded(number, kMaxRobots);
    if (!in.ok() || !is_slot(number) || !slots_[number].used() || slots_[number].has_trajectory())
      return std::unexpected(not_sound("the slot of a trajectory"));
    found.reset();
    slots_[number].restore_trajectory(
        in, [&](const motion::Trajectory* wanted) { return lend(wanted == nullptr ? nullptr : found); });
    if (!in.ok()) return std::unexpected(not_sound(fmt::format("the trajectory of the robot in slot {}", number)));
  }
  if (!in.ok() || !in.at_end()) return std::unexpected(not_sound("its trajectories"));
  return {};
}

Result<void> Engine::restore_haptics(StateReader& in, const StartParts& parts, EngineStart& out) {
  const auto lend_instrument = [this](haptics::Instrument&& instrument) {
    return lend(std::make_shared<const haptics::Instrument>(std::move(instrument)));
  };
  while (!in.at_end()) {
    std::size_t channel = 0;
    in.bounded(channel, kMaxHapticDevices);
    if (in.ok() && channel == kMaxHapticDevices) return restore_trajectories(in.rest(), parts);
    if (!in.ok() || channel >= haptics_.size() || out.open_devices[channel] == 0 || out.restored[channel])
      return std::unexpected(not_sound("the number of a haptic channel"));
    if (!haptics_.restore(channel, in, lend(parts.device(channel, out.open_devices[channel])), lend_instrument,
                          slots_.size()))
      return std::unexpected(not_sound(fmt::format("haptic channel {}", channel)));
    out.restored[channel] = true;
  }
  return {};
}

Result<EngineStart> Engine::restore(std::span<const std::byte> start, const StartParts& parts) {
  std::vector<std::shared_ptr<const kinematics::Chain>> found;
  StateReader in(start, [&](std::uint64_t id) -> const void* {
    const auto one = parts.chain(id);
    if (one && std::ranges::find(found, one) == found.end()) found.push_back(one);
    return one.get();
  });
  const auto lend_chain = [&](const kinematics::Chain* wanted) -> Lease<const kinematics::Chain> {
    const auto one = std::ranges::find(found, wanted, [](const auto& known) { return known.get(); });
    return one == found.end() ? Lease<const kinematics::Chain>() : lend(*one);
  };
  EngineCapacity capacity;
  EngineStart out;
  transfer_capacity(in, capacity);
  if (capacity.robots > capacity_.robots || capacity.haptic_devices > capacity_.haptic_devices)
    return std::unexpected(not_sound("it is of a larger engine"));
  in(head_.missed_periods, head_.commands_done, head_.commands_refused, out.open_devices);
  std::size_t used = 0;
  in.bounded(used, slots_.size());
  for (std::size_t i = 0; i < used && in.ok(); ++i) {
    std::size_t number = 0;
    in.bounded(number, kMaxRobots);
    if (!in.ok() || !is_slot(number) || slots_[number].used()) return std::unexpected(not_sound("a slot"));
    slots_[number].restore(in, lend_chain);
    if (!in.ok() || !slots_[number].used())
      return std::unexpected(not_sound(fmt::format("the robot in slot {}", number)));
  }
  std::size_t couplings = 0;
  in.bounded(couplings, slots_.size());
  for (std::size_t i = 0; i < couplings && in.ok(); ++i) {
    Coupling coupling;
    in(coupling);
    if (!in.ok() || !couplings_.restore(coupling, slots_)) return std::unexpected(not_sound("a coupling"));
  }
  if (!in.ok()) return std::unexpected(not_sound("its length"));
  if (auto haptics = restore_haptics(in, parts, out); !haptics) return std::unexpected(haptics.error());
  next_command_ = head_.commands_done + 1;
  out.commands_done = head_.commands_done;
  return out;
}

}  // namespace cellmirror::engine
