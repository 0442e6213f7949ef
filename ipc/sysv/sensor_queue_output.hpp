// What leaves over the SENSOR channel (manual 1.2.1: key 1990, type 5): robot parameters (ROBOT send_on), ultrasonic
// ranges (SET_USSPAR), light barriers, what touches and what is near, cameras that are online (CAM_ONLINE), events of
// tissue.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/camera_state.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/tissue_output.hpp"

namespace cellmirror {

// Never waits for a reader: a full queue loses its oldest records, which is counted. A queue removed by another program
// is recreated. FramePose is not sent here. All publishing by one thread. Counters: sent, dropped (old records taken
// out unread), unread (of these, those for which no other program had read the queue within 10 s), refused (new ones
// that found no room at all, or values that are not finite), of these sent and refused by kind (ranges_sent, ...),
// events_missing and tissue_events_missing (gaps in the events that were given to this output), recreated, discarded
// (left by an earlier process), waiting.
class SensorQueueOutput final : public RobotStateOutput,
                                public FindingsOutput,
                                public CameraOutput,
                                public TissueEventOutput {
 public:
  // Fails where the queue cannot be had; see OwnedQueue::make.
  static Result<std::unique_ptr<SensorQueueOutput>> open(const QueueConfig& config, const std::string& instance);
  ~SensorQueueOutput() override;  // removes the queue

  void publish(Timestamp time, std::span<const RobotState> robots, std::span<const FramePose> frames) override;
  // A record a sensor, or one for all (more where they do not fit). Readings that are not finite are refused.
  void publish_ranges(std::span<const RangeReading> readings, RangeSendMode mode) override;
  // A record for each barrier whose state has changed, and for each once a second.
  void publish_barriers(std::span<const BarrierReading> barriers) override;
  // A record for each event, then one for the state where that is due (ProximityPacing). The state of the same
  // computation again sends no event twice.
  void publish_proximity(const ProximityState& state) override;
  // A record a camera. Those whose numbers are not finite are refused.
  void publish_cameras(Timestamp time, std::span<const CameraState> cameras) override;
  // A record an event. Those whose numbers are not finite are refused.
  void publish_tissue_events(std::span<const NamedTissueEvent> events) override;
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> counters() const override;
  [[nodiscard]] std::string name() const override;  // "sensor queue 0x7c6 (1990)"
  [[nodiscard]] std::string problem() const override;
  // Looks once a second whether the queue is still there and ours, also while there is nothing to send.
  void keep(Timestamp now) override;

 private:
  struct Impl;
  explicit SensorQueueOutput(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror
