#include "app/gateway/outputs.hpp"

#include <utility>

#include "drivers/dds/dds_output.hpp"
#include "ipc/sysv/sensor_queue_output.hpp"

namespace cellmirror::app {

namespace {

Nanoseconds period_of(double rate_hz) { return Nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz)); }

}  // namespace

Result<std::vector<PublishedOutput>> make_outputs(const QueueConfig& queues, const DdsOutputConfig& config,
                                                  const std::string& instance) {
  std::vector<PublishedOutput> outputs;
  auto sensor = SensorQueueOutput::open(queues, instance);
  if (!sensor) return std::unexpected(sensor.error());
  outputs.push_back({std::move(*sensor), period_of(queues.sensor_rate_hz)});
  if (!config.enabled) return outputs;
  auto published = dds::make_dds_output(config);
  if (!published) return std::unexpected(published.error());
  outputs.push_back({std::move(*published), period_of(config.rate_hz)});
  return outputs;
}

}  // namespace cellmirror::app
