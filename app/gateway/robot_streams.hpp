// Makes the stream that a cell file describes, by the driver of its kind.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

// Closed; `clock` outlives it. Fails for what can never work, e.g. a DBC file without the signal that the cell names.
Result<std::unique_ptr<JointStream>> make_robot_stream(const StreamConfig& config, const Clock& clock);

}  // namespace cellmirror::app
