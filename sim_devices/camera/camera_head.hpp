// The head as a device: follows the records of its camera, and its two drives answer on CANopen as those of a robot.
#pragma once

#include <memory>
#include <string>

#include "sim_devices/camera/camera_reader.hpp"
#include "sim_devices/camera/pan_tilt_head.hpp"
#include "sim_devices/robot/cia402_robots.hpp"
#include "sim_devices/robot/device.hpp"

namespace cellmirror::sim {

struct CameraHeadConfig {
  std::string camera;  // name of its workframe
  std::int32_t key = 0;
  bool take = false;
  double look_hz = 200;  // polling rate for records
  HeadConfig head;
  Cia402RobotsConfig drives;  // one robot of two joints: pan, tilt
};

class CameraHead final : public SimulatedDevice {
 public:
  CameraHead(const CameraHeadConfig& config, std::unique_ptr<CanChannel> channel);
  ~CameraHead() override;

  void start(Timestamp now) override;
  void work(Timestamp now) override;
  [[nodiscard]] Timestamp next() const override;
  void wait_until(Timestamp t) override { drives_->wait_until(t); }
  Result<std::string> execute(const ControlCommand& command, Timestamp now) override;
  // "fault stuck:joint=1", "clear stuck", "clear 1001".
  std::optional<Result<std::string>> execute_own(std::string_view line, Timestamp now) override;
  [[nodiscard]] DeviceStatus status(Timestamp now) const override;

  Result<int> add_fault(const HeadFaultSpec& spec, Timestamp now) { return head_.add_fault(spec, now); }
  [[nodiscard]] const PanTiltHead& head() const { return head_; }

 private:
  class Angles;  // what the drives measure

  CameraHeadConfig config_;
  PanTiltHead head_;
  CameraReader reader_;
  std::unique_ptr<Cia402Robots> drives_;
  Pacer looks_;
  Timestamp heard_;  // when the newest record came
};

}  // namespace cellmirror::sim
