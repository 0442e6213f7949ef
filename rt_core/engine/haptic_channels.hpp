// The haptic devices inside the tick: a channel each, with the newest surroundings of its instrument and the newest
// force of soft tissue on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/command.hpp"
#include "rt_core/engine/tick_state.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/haptic_channel.hpp"
#include "rt_core/haptics/tissue_force.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::engine {

// Between a channel and its device: keeps what the device gave last, for a recording of the tick.
class WatchedDevice final : public HapticDevicePort {
 public:
  void watch(HapticDevicePort& device) CELL_RT { device_ = &device; }
  HapticRead read(HapticSample& sample) CELL_RT override;
  void write(const HapticOutput& output) CELL_RT override { device_->write(output); }
  [[nodiscard]] HapticRead outcome() const CELL_RT { return outcome_; }
  [[nodiscard]] HapticSample& sample() CELL_RT { return sample_; }  // of the last read that was fresh

 private:
  HapticDevicePort* device_ = nullptr;
  HapticRead outcome_ = HapticRead::none;
  HapticSample sample_;
};

// What a channel took in a step. Null: nothing new.
struct HapticTaken {
  HapticRead outcome = HapticRead::none;
  HapticSample* sample = nullptr;
  const haptics::ContactModel* model = nullptr;
  const haptics::TissueForce* tissue = nullptr;
};

// Tick thread only, but for the inlets.
class HapticChannels {
 public:
  // As many channels as the engine was made for; at most kMaxHapticDevices.
  explicit HapticChannels(std::size_t channels) : channels_(channels) {}

  [[nodiscard]] std::size_t size() const CELL_RT { return channels_.size(); }
  // These give false where there is no such channel. `now`: the time of the tick.
  // False too without an instrument or a device.
  bool open(OpenHaptic& command, Timestamp now) CELL_RT;
  bool close(std::size_t channel) CELL_RT;
  // False too where the reset was refused.
  bool reset(std::size_t channel) CELL_RT;
  bool set_device_gone(std::size_t channel, bool gone) CELL_RT;

  [[nodiscard]] bool used(std::size_t channel) const CELL_RT { return channels_[channel].channel.used(); }
  // Of the instrument's robot.
  [[nodiscard]] std::size_t slot(std::size_t channel) const CELL_RT { return channels_[channel].instrument->slot; }
  // Reads the device, answers it. `robot` is the instrument's. True where `sample` holds where it is to stand.
  bool step(std::size_t channel, const CycleContext& context, const RobotTickState& robot, JointSample& sample) CELL_RT;
  void publish(std::span<HapticState, kMaxHapticDevices> out) const CELL_RT;
  // Of the last step(); valid until the next one.
  [[nodiscard]] const HapticTaken& taken(std::size_t channel) const CELL_RT { return channels_[channel].taken; }
  [[nodiscard]] const HapticState& state(std::size_t channel) const CELL_RT {
    return channels_[channel].channel.state();
  }
  // Which one it is: null where the channel is closed.
  [[nodiscard]] const HapticDevicePort* device(std::size_t channel) const CELL_RT {
    return channels_[channel].device.get();
  }

  // An open channel for the beginning of a recording: with its instrument, but without its device.
  void write(std::size_t channel, StateWriter& out) CELL_RT;
  // Not for the tick. `device` stands for the one of then, `lend_instrument` lends what was read. False where the bytes
  // are no state of a channel whose instrument's robot is in one of `slots` slots.
  bool restore(std::size_t channel, StateReader& in, Lease<HapticDevicePort> device,
               const std::function<Lease<const haptics::Instrument>(haptics::Instrument&&)>& lend_instrument,
               std::size_t slots);

  // For one worker thread.
  [[nodiscard]] Latest<haptics::ContactModel>& inlet(std::size_t channel) {
    CELLMIRROR_EXPECTS(channel < channels_.size());
    return channels_[channel].inlet;
  }
  // For one worker thread, perhaps another one.
  [[nodiscard]] Latest<haptics::TissueForce>& tissue_inlet(std::size_t channel) {
    CELLMIRROR_EXPECTS(channel < channels_.size());
    return channels_[channel].tissue_inlet;
  }

 private:
  struct Entry {
    haptics::HapticChannel channel;
    Lease<const haptics::Instrument> instrument;
    Lease<HapticDevicePort> device;
    Timestamp opened;
    bool device_gone = false;
    WatchedDevice watched;
    HapticTaken taken;
    // What the inlets gave in the last step; null: there was none. Valid until the next one.
    const haptics::ContactModel* newest_model = nullptr;
    const haptics::TissueForce* newest_tissue = nullptr;
    Latest<haptics::ContactModel> inlet;
    Latest<haptics::TissueForce> tissue_inlet;
  };

  std::vector<Entry> channels_;
};

}  // namespace cellmirror::engine
