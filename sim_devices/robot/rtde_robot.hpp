// A controller of Universal Robots that gives its joints by RTDE: a TCP server with a few clients.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/motion/motion_source.hpp"
#include "sim_devices/robot/device.hpp"
#include "sim_devices/robot/rtde_message.hpp"

namespace cellmirror::sim {

struct RtdeRobotConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = rtde::kPort;
  double rate_hz = 125;  // a client may ask for less
  std::uint64_t seed = 1;
};

class RtdeRobot final : public FaultyDevice<RtdeMessage> {
 public:
  // Fails where it cannot listen there.
  static Result<std::unique_ptr<RtdeRobot>> make(const RtdeRobotConfig& config, std::unique_ptr<MotionSource> motion);

  void start(Timestamp now) override;
  void work(Timestamp now) override;
  [[nodiscard]] Timestamp next() const override;
  void wait_until(Timestamp t) override;
  [[nodiscard]] DeviceStatus status(Timestamp now) const override;

 private:
  static constexpr std::size_t kMostClients = 8;

  struct Client {
    Descriptor socket;
    rtde::PackageSplitter splitter;
    rtde::Bytes waiting;  // to be sent
    bool started = false;
    bool has_all = false;  // it has asked for kAllVariables
    bool ended = false;
  };

  RtdeRobot(const RtdeRobotConfig& config, std::unique_ptr<MotionSource> motion);
  Result<void> listen();
  [[nodiscard]] Result<void> check(const FaultSpec& spec) const override;
  bool transmit(const RtdeMessage& message) override;
  void accept_clients();
  void read(Client& client);
  void answer(Client& client, const rtde::Package& package);
  static void send(Client& client, const rtde::Bytes& bytes);
  void send_sample(Timestamp now);

  RtdeRobotConfig config_;
  std::unique_ptr<MotionSource> motion_;
  Descriptor listener_;
  std::vector<Client> clients_;
  std::vector<JointValue> values_;
  Pacer pacer_;
  Timestamp started_;
};

}  // namespace cellmirror::sim
