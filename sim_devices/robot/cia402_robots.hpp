// Robots of CiA 402 drives on one CAN bus: a drive a joint, node ids in a row.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/cia402/drive.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/faults/can_traits.hpp"
#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

struct Cia402RobotsConfig {
  std::string endpoint;
  int first_robot = 1;
  // One list a robot: the node id of each joint.
  std::vector<std::vector<std::uint8_t>> nodes;
  std::vector<double>
      increments_per_unit;  // a value a joint; increments per rad (or m), negative where it turns the other way
  std::uint16_t sample_period_ms = 10;  // event timer of the TPDOs where they do not wait for SYNC
  bool on_sync = false;
  bool with_velocity = false;    // TPDO2: velocity and torque
  bool self_starting = false;    // operational without an NMT start
  bool follows_targets = false;  // moves as it is commanded, not by the motion
  std::uint16_t heartbeat_ms = 100;
  Nanoseconds sync_period{0};  // > 0: produces SYNC
  std::uint64_t seed = 1;
};

class Cia402Robots final : public FaultyDevice<CanFrame> {
 public:
  Cia402Robots(const Cia402RobotsConfig& config, std::shared_ptr<const MotionSource> motion,
               std::unique_ptr<CanChannel> channel);

  void start(Timestamp now) override;
  void work(Timestamp now) override;
  [[nodiscard]] Timestamp next() const override;
  void wait_until(Timestamp t) override;
  [[nodiscard]] DeviceStatus status(Timestamp now) const override;

 private:
  // A joint's drive; what it sends goes into the pipeline.
  struct Node final : public can::Cia402DriveOutput {
    Node(Cia402Robots& owner, Source where, const can::Cia402DriveConfig& config);
    void send(const CanFrame& frame) override;

    Cia402Robots& owner;
    Source source;
    can::Cia402Drive drive;
    bool needs_ticks = false;  // its mapping was changed to event driven without a timer
  };

  static constexpr std::size_t kMostInbox = 256;

  [[nodiscard]] Result<void> check(const FaultSpec& spec) const override;
  Result<std::string> send_emergency(const SendEmergency& command, Timestamp now) override;
  bool transmit(const CanFrame& frame) override { return channel_->send(frame); }

  void update_life(Timestamp now);
  void hear(const CanFrame& frame, Timestamp now);
  void measure(Node& node, Timestamp now);
  void note_mapping(Node& node);
  void advance(Timestamp now);
  void send_sync(Timestamp now);
  [[nodiscard]] static bool sends_on_change_only(const can::Cia402Drive& drive);

  Cia402RobotsConfig config_;
  std::shared_ptr<const MotionSource> motion_;
  std::unique_ptr<CanChannel> channel_;
  CanChannelStatus channel_status_;  // as of the newest work(): status() comes while wait_until() receives
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<JointValue> values_;  // of the robot `values_robot_` at `values_time_`
  int values_robot_ = 0;
  Timestamp values_time_;
  Timestamp now_;  // of the call under way, for what the drives send
  Pacer ticks_;
  Pacer sync_;
  std::vector<ReceivedCanFrame> inbox_;
  bool any_needs_ticks_ = false;
};

}  // namespace cellmirror::sim
