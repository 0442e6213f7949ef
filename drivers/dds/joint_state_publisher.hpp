// A publisher of sensor_msgs/JointState, for simulators and tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

struct JointStatePublisherConfig {
  int domain = 0;                               // 0..232
  std::string interface_address = "127.0.0.1";  // IPv4 address of this machine
  std::string topic = "rt/joint_states";
  bool reliable = true;  // as ROS 2's default; matches best-effort and reliable readers
  int depth = 64;        // samples kept for repetition to reliable readers
  DdsSecurityConfig security = {};
  std::string partition = {};  // of DDS; empty: none
};

// One calling thread. Publishers and streams of one process share a DDS participant for each domain and interface.
class JointStatePublisher {
 public:
  // Fails where the configuration is wrong or the address is none of this machine's.
  [[nodiscard]] static Result<std::unique_ptr<JointStatePublisher>> make(const JointStatePublisherConfig& config);
  ~JointStatePublisher();
  JointStatePublisher(const JointStatePublisher&) = delete;
  JointStatePublisher& operator=(const JointStatePublisher&) = delete;

  // Never waits for readers. False where the sample could not be handed to the network (counted by the caller).
  bool publish(const JointState& message);
  // Any bytes as the payload, encapsulation header included; for fault injection.
  bool publish_bytes(std::span<const std::byte> payload);
  // Readers that are matched now; any thread.
  [[nodiscard]] int matched_readers() const;

 private:
  struct Impl;
  explicit JointStatePublisher(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::dds
