#include "app/io/outputs.hpp"

#include <utility>

#include "drivers/dds/dds_output.hpp"
#include "ipc/sysv/sensor_queue_output.hpp"

namespace cellmirror::app {

namespace {

Nanoseconds period_of(double rate_hz) { return Nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz)); }

}  // namespace

void add_output(std::vector<PublishedOutput>& outputs, std::unique_ptr<RobotStateOutput> output, double rate_hz) {
  auto* findings = dynamic_cast<FindingsOutput*>(output.get());
  auto* forces = dynamic_cast<ForceOutput*>(output.get());
  auto* cameras = dynamic_cast<CameraOutput*>(output.get());
  auto* tissue_events = dynamic_cast<TissueEventOutput*>(output.get());
  auto* tissue_shapes = dynamic_cast<TissueShapeOutput*>(output.get());
  auto* description = dynamic_cast<DescriptionOutput*>(output.get());
  outputs.push_back(
      {std::move(output), period_of(rate_hz), findings, forces, cameras, tissue_events, tissue_shapes, description});
}

Result<std::vector<PublishedOutput>> make_outputs(const QueueConfig& queues, const DdsOutputConfig& config,
                                                  const std::string& instance) {
  std::vector<PublishedOutput> outputs;
  auto sensor = SensorQueueOutput::open(queues, instance);
  if (!sensor) return std::unexpected(sensor.error());
  add_output(outputs, std::move(*sensor), queues.sensor_rate_hz);
  if (!config.enabled) return outputs;
  auto published = dds::make_dds_output(config);
  if (!published) return std::unexpected(published.error());
  add_output(outputs, std::move(*published), config.rate_hz);
  return outputs;
}

}  // namespace cellmirror::app
