// A robot that sends its joints as signals of a DBC file, like vehicles and simple drives.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/dbc/dbc.hpp"
#include "drivers/can/e2e/e2e.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/faults/can_traits.hpp"
#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

struct DbcRobotConfig {
  std::string endpoint;
  std::vector<DbcSignalConfig> signals;  // `scale` and `offset` as a cell file has them: SI = physical * scale + offset
  std::vector<E2eConfig> protections = {};  // of messages with signals
  std::size_t joints = 0;
  int robot = 1;
  double rate_hz = 100;
  std::uint64_t seed = 1;
};

class DbcRobot final : public FaultyDevice<CanFrame> {
 public:
  // Refuses signals that the file does not have, all of them in one message.
  static Result<std::unique_ptr<DbcRobot>> make(const DbcRobotConfig& config, const can::Dbc& dbc,
                                                std::unique_ptr<MotionSource> motion,
                                                std::unique_ptr<CanChannel> channel);

  void start(Timestamp now) override;
  void work(Timestamp now) override;
  [[nodiscard]] Timestamp next() const override;
  void wait_until(Timestamp t) override;
  [[nodiscard]] DeviceStatus status(Timestamp now) const override;

 private:
  struct Entry {
    can::DbcSignal signal;
    DbcSignalConfig config;
    bool too_small = false;  // a value did not fit, which was reported
  };
  // What one frame holds: the signals of a message that can be in it together.
  struct Frame {
    can::DbcMessage message;
    CanFrame start;  // identifier, length and the multiplexers
    std::vector<Entry> entries;
    int joint = 0;  // from 1, where all its signals belong to one joint
    std::optional<can::E2eFormat> protection = {};
  };

  DbcRobot(const DbcRobotConfig& config, std::unique_ptr<MotionSource> motion, std::unique_ptr<CanChannel> channel);
  void take_in(const can::DbcMessage& message, const can::DbcSignal& signal, const DbcSignalConfig& config);
  Result<void> protect_message(const E2eConfig& config, const can::Dbc& dbc);
  // Counts on by messages, whichever of its frames goes.
  void protect_frame(const Frame& frame, CanFrame& filled);
  void send_frame(Frame& frame, Timestamp now);
  // A replacement for a value out of range is reported once per signal.
  void note_fit(const Frame& frame, Entry& entry, double wanted, const CanFrame& filled);
  [[nodiscard]] Result<void> check(const FaultSpec& spec) const override;
  bool transmit(const CanFrame& frame) override { return channel_->send(frame); }

  DbcRobotConfig config_;
  std::unique_ptr<MotionSource> motion_;
  std::unique_ptr<CanChannel> channel_;
  std::vector<Frame> frames_;
  std::map<std::string, std::uint16_t, std::less<>> next_counter_;  // by message
  std::vector<JointValue> values_;
  Pacer pacer_;
  std::uint64_t did_not_fit_ = 0;
};

}  // namespace cellmirror::sim
