// Makes the outputs for summaries of the cell.
#pragma once

#include <memory>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/ports/summary_output.hpp"

namespace cellmirror::app {

// None where the cell file wants none.
[[nodiscard]] Result<std::vector<std::unique_ptr<SummaryOutput>>> make_summary_outputs(const DdsOutputConfig& dds);

}  // namespace cellmirror::app
