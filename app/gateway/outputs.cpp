#include "app/gateway/outputs.hpp"

#include <utility>

#include "drivers/dds/dds_output.hpp"
#include "drivers/dds/image_output.hpp"
#include "ipc/sysv/sensor_queue_output.hpp"

namespace cellmirror::app {

namespace {

Nanoseconds period_of(double rate_hz) { return Nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz)); }

void add(std::vector<PublishedOutput>& outputs, std::unique_ptr<RobotStateOutput> output, double rate_hz) {
  auto* findings = dynamic_cast<FindingsOutput*>(output.get());
  auto* forces = dynamic_cast<ForceOutput*>(output.get());
  auto* cameras = dynamic_cast<CameraOutput*>(output.get());
  outputs.push_back({std::move(output), period_of(rate_hz), findings, forces, cameras});
}

}  // namespace

Result<std::vector<PublishedOutput>> make_outputs(const QueueConfig& queues, const DdsOutputConfig& config,
                                                  const std::string& instance) {
  std::vector<PublishedOutput> outputs;
  auto sensor = SensorQueueOutput::open(queues, instance);
  if (!sensor) return std::unexpected(sensor.error());
  add(outputs, std::move(*sensor), queues.sensor_rate_hz);
  if (!config.enabled) return outputs;
  auto published = dds::make_dds_output(config);
  if (!published) return std::unexpected(published.error());
  add(outputs, std::move(*published), config.rate_hz);
  return outputs;
}

Result<std::vector<Studio::Output>> make_picture_outputs(const DdsOutputConfig& config) {
  std::vector<Studio::Output> outputs;
  if (!config.enabled || config.pictures.topic.empty()) return outputs;
  auto output = dds::make_image_output(config);
  if (!output) return std::unexpected(output.error());
  PictureRequest wish;
  wish.view = config.pictures.view;
  if (!config.pictures.camera.empty()) wish.camera = config.pictures.camera;
  wish.width = config.pictures.width;
  wish.height = config.pictures.height;
  wish.rate_hz = config.pictures.rate_hz;
  wish.quality = config.pictures.quality;
  outputs.push_back({std::move(*output), std::move(wish)});
  return outputs;
}

}  // namespace cellmirror::app
