// Something that is wrong around the running gateway and lasts: for status, the page and metrics.
#pragma once

#include <string>
#include <vector>

namespace cellmirror::app {

struct Problem {
  // script_queue, reply_queue, sensor_queue, force_guard, command_log, alarm_log, recording, summary, mqtt, process,
  // stream
  std::string kind;
  std::string text;  // with the remedy
};

using Problems = std::vector<Problem>;

}  // namespace cellmirror::app
