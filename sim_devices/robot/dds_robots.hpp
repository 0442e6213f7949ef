// Robots that publish their joints as ROS 2's sensor_msgs/JointState, as a ROS 2 controller does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/dds/joint_state_publisher.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/faults/joint_state_traits.hpp"
#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

struct DdsRobotsConfig {
  int domain = 0;
  std::string interface_address = "127.0.0.1";
  std::string topic = "rt/joint_states";  // with {}: one topic a robot, {} is its number
  bool reliable = true;
  std::vector<std::string> joint_names;
  std::string name_prefix;  // put before each joint name; {} is the robot's number
  int first_robot = 1;
  int robots = 1;
  double rate_hz = 125;
  int groups = 1;  // the robots of a period are spread over this many instants
  bool stamped = true;
  std::uint64_t seed = 1;
  DdsSecurityConfig security = {};
  std::string partition = {};
};

class DdsRobots final : public FaultyDevice<JointStateMessage> {
 public:
  static Result<std::unique_ptr<DdsRobots>> make(const DdsRobotsConfig& config, std::unique_ptr<MotionSource> motion);

  void start(Timestamp now) override;
  void work(Timestamp now) override;
  [[nodiscard]] Timestamp next() const override;
  void wait_until(Timestamp t) override { sleep_until(t); }
  [[nodiscard]] DeviceStatus status(Timestamp now) const override;

  // The fewest readers that any of the topics has.
  [[nodiscard]] int matched_readers() const;

 private:
  struct Robot {
    int number = 1;
    std::size_t writer = 0;
    dds::JointState state;
  };

  DdsRobots(const DdsRobotsConfig& config, std::unique_ptr<MotionSource> motion);
  [[nodiscard]] Result<void> check(const FaultSpec& spec) const override;
  bool transmit(const JointStateMessage& message) override;
  void send_sample(Robot& robot, Timestamp now);

  DdsRobotsConfig config_;
  std::unique_ptr<MotionSource> motion_;
  std::vector<std::unique_ptr<dds::JointStatePublisher>> writers_;
  std::vector<Robot> robots_;
  std::vector<JointValue> values_;
  Pacer pacer_;
  std::uint64_t ticks_ = 0;
};

}  // namespace cellmirror::sim
