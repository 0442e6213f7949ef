// Makes the outputs for robot states, collisions and ranges: the SENSOR channel, and DDS where the cell file wants it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/io/publisher.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

Result<std::vector<PublishedOutput>> make_outputs(const QueueConfig& queues, const DdsOutputConfig& dds,
                                                  const std::string& instance);

// `output` is given what it is for besides robot states.
void add_output(std::vector<PublishedOutput>& outputs, std::unique_ptr<RobotStateOutput> output, double rate_hz);

}  // namespace cellmirror::app
