// Publishes summaries of the cell as ROS 2's std_msgs/String.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/summary_output.hpp"

namespace cellmirror::dds {

// On `config.summary_topic`, in no partition, so that a control room sees all cells; kept for readers that come later.
// Fails as make_dds_output(), on whose participant it is. Whether the topic is switched off is the caller's to check.
[[nodiscard]] Result<std::unique_ptr<SummaryOutput>> make_summary_output(const DdsOutputConfig& config);

}  // namespace cellmirror::dds
