#include "rt_core/engine/haptic_channels.hpp"

namespace cellmirror::engine {

bool HapticChannels::concerns(const Command& command) CELL_RT {
  return command.kind == CommandKind::open_haptic || command.kind == CommandKind::close_haptic ||
         command.kind == CommandKind::reset_haptic || command.kind == CommandKind::haptic_device;
}

bool HapticChannels::apply(const Command& command, Timestamp now, std::size_t robots) CELL_RT {
  if (command.channel >= channels_.size()) return false;
  Entry& entry = channels_[command.channel];
  switch (command.kind) {
    case CommandKind::open_haptic:
      if (command.instrument == nullptr || command.device == nullptr || command.instrument->slot >= robots)
        return false;
      open(entry, command, now);
      return true;
    case CommandKind::close_haptic:
      if (entry.channel.used()) entry.channel.close();
      entry.instrument = nullptr;
      entry.device = nullptr;
      return true;
    case CommandKind::reset_haptic:
      return entry.channel.used() && !entry.device_gone && entry.channel.reset();
    case CommandKind::haptic_device:
      entry.device_gone = command.device_gone;
      return true;
    default:
      return false;
  }
}

void HapticChannels::open(Entry& entry, const Command& command, Timestamp now) CELL_RT {
  entry.instrument = command.instrument;
  entry.opened = now;
  if (entry.channel.used() && entry.device == command.device) {
    entry.channel.exchange(*command.instrument);
    return;
  }
  if (entry.channel.used()) entry.channel.close();
  entry.device = command.device;
  entry.device_gone = false;
  entry.channel.open(*command.instrument, *command.device);
}

bool HapticChannels::step(std::size_t channel, const CycleContext& context, const RobotTickState& robot,
                          JointSample& sample) CELL_RT {
  Entry& entry = channels_[channel];
  JointValues q{};
  for (std::size_t i = 0; i < robot.joint_count; ++i) q[i] = robot.joints[i].position;
  const haptics::ContactModel& newest = entry.inlet.read().value;
  haptics::TickInput input;
  input.now = context.now;
  input.period = context.period;
  input.missed = context.missed;
  // One that was found for an instrument that had this channel before says nothing about this one.
  const bool fits =
      newest.sequence != 0 && newest.slot == entry.instrument->slot && newest.posture_time >= entry.opened;
  input.model = fits ? &newest : nullptr;
  input.q = std::span<const double>(q).first(robot.joint_count);
  input.device_gone = entry.device_gone;
  return entry.channel.step(input, sample);
}

void HapticChannels::publish(std::span<HapticState, kMaxHapticDevices> out) const CELL_RT {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    // Each buffer holds an older state, so closed channels are cleared in each of them.
    out[i] = used(i) ? channels_[i].channel.state() : HapticState{};
  }
}

}  // namespace cellmirror::engine
