// Makes the outputs for robot states, collisions and ranges: the SENSOR channel, and DDS where the cell file wants it.
#pragma once

#include <string>
#include <vector>

#include "app/gateway/publisher.hpp"
#include "app/gateway/studio.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

Result<std::vector<PublishedOutput>> make_outputs(const QueueConfig& queues, const DdsOutputConfig& dds,
                                                  const std::string& instance);

// Pictures on DDS, where the cell file wants them.
Result<std::vector<Studio::Output>> make_picture_outputs(const DdsOutputConfig& dds);

}  // namespace cellmirror::app
