#include "rt_core/engine/haptic_channels.hpp"

#include <utility>

#include "rt_core/engine/instrument_bytes.hpp"
#include "rt_core/engine/state_transfer.hpp"

namespace cellmirror::engine {

HapticRead WatchedDevice::read(HapticSample& sample) CELL_RT {
  outcome_ = device_->read(sample);
  if (outcome_ == HapticRead::fresh) sample_ = sample;
  return outcome_;
}

bool HapticChannels::open(OpenHaptic& command, Timestamp now) CELL_RT {
  if (command.channel >= channels_.size() || !command.instrument || !command.device) return false;
  Entry& entry = channels_[command.channel];
  if (entry.channel.used() && entry.device.get() == command.device.get()) {
    entry.channel.exchange(*command.instrument);
  } else {
    if (entry.channel.used()) entry.channel.close();
    entry.device_gone = false;
    entry.watched.watch(*command.device);
    entry.channel.open(*command.instrument, entry.watched);
  }
  // Only now: until here the channel has used the ones before.
  entry.instrument = std::move(command.instrument);
  entry.device = std::move(command.device);
  entry.opened = now;
  return true;
}

bool HapticChannels::close(std::size_t channel) CELL_RT {
  if (channel >= channels_.size()) return false;
  Entry& entry = channels_[channel];
  if (entry.channel.used()) entry.channel.close();
  entry.instrument.give_back();
  entry.device.give_back();
  return true;
}

bool HapticChannels::reset(std::size_t channel) CELL_RT {
  if (channel >= channels_.size()) return false;
  Entry& entry = channels_[channel];
  return entry.channel.used() && !entry.device_gone && entry.channel.reset();
}

bool HapticChannels::set_device_gone(std::size_t channel, bool gone) CELL_RT {
  if (channel >= channels_.size()) return false;
  channels_[channel].device_gone = gone;
  return true;
}

bool HapticChannels::step(std::size_t channel, const CycleContext& context, const RobotTickState& robot,
                          JointSample& sample) CELL_RT {
  Entry& entry = channels_[channel];
  JointValues q{};
  for (std::size_t i = 0; i < robot.joint_count; ++i) q[i] = robot.joints[i].position;
  const auto model = entry.inlet.read();
  const haptics::ContactModel& newest = model.value;
  entry.newest_model = &newest;
  haptics::TickInput input;
  input.now = context.now;
  input.period = context.period;
  input.missed = context.missed;
  // One that was found for an instrument that had this channel before says nothing about this one.
  const bool fits =
      newest.sequence != 0 && newest.slot == entry.instrument->slot && newest.posture_time >= entry.opened;
  input.model = fits ? &newest : nullptr;
  const auto response = entry.tissue_inlet.read();
  const haptics::TissueForce& tissue = response.value;
  entry.newest_tissue = &tissue;
  input.tissue = tissue.sequence != 0 && tissue.posture_time >= entry.opened ? &tissue : nullptr;
  input.q = std::span<const double>(q).first(robot.joint_count);
  input.device_gone = entry.device_gone;
  const bool moved = entry.channel.step(input, sample);
  entry.taken = {.outcome = entry.watched.outcome(),
                 .sample = entry.watched.outcome() == HapticRead::fresh ? &entry.watched.sample() : nullptr,
                 .model = model.is_new ? &newest : nullptr,
                 .tissue = response.is_new ? &tissue : nullptr};
  return moved;
}

void HapticChannels::publish(std::span<HapticState, kMaxHapticDevices> out) const CELL_RT {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    // Each buffer holds an older state, so closed channels are cleared in each of them.
    out[i] = used(i) ? channels_[i].channel.state() : HapticState{};
  }
}

void HapticChannels::write(std::size_t channel, StateWriter& out) CELL_RT {
  Entry& entry = channels_[channel];
  write_instrument(out, *entry.instrument);
  out(entry.opened, entry.device_gone, entry.channel);
  haptics::ContactModel model = entry.newest_model != nullptr ? *entry.newest_model : haptics::ContactModel();
  haptics::TissueForce tissue = entry.newest_tissue != nullptr ? *entry.newest_tissue : haptics::TissueForce();
  out(model, tissue);
}

bool HapticChannels::restore(
    std::size_t channel, StateReader& in, Lease<HapticDevicePort> device,
    const std::function<Lease<const haptics::Instrument>(haptics::Instrument&&)>& lend_instrument, std::size_t slots) {
  Entry& entry = channels_[channel];
  auto instrument = read_instrument(in);
  if (!instrument || instrument->slot >= slots || !device || entry.channel.used()) return false;
  entry.instrument = lend_instrument(*std::move(instrument));
  entry.device = std::move(device);
  entry.watched.watch(*entry.device);
  in(entry.opened, entry.device_gone);
  if (!entry.channel.restore(in, *entry.instrument, entry.watched)) return false;
  haptics::ContactModel model;
  haptics::TissueForce tissue;
  in(model, tissue);
  if (!in.ok()) return false;
  // As the next step would find them: a sequence of 0 is none.
  if (model.sequence != 0) {
    entry.inlet.writable() = model;
    entry.inlet.publish();
  }
  if (tissue.sequence != 0) {
    entry.tissue_inlet.writable() = tissue;
    entry.tissue_inlet.publish();
  }
  return true;
}

}  // namespace cellmirror::engine
