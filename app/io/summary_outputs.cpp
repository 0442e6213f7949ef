#include "app/io/summary_outputs.hpp"

#include <utility>

#include "drivers/dds/summary_output.hpp"

namespace cellmirror::app {

Result<std::vector<std::unique_ptr<SummaryOutput>>> make_summary_outputs(const DdsOutputConfig& dds) {
  std::vector<std::unique_ptr<SummaryOutput>> outputs;
  if (!dds.enabled || dds.summary_topic.empty()) return outputs;
  auto made = dds::make_summary_output(dds);
  if (!made) return std::unexpected(made.error());
  outputs.push_back(std::move(*made));
  return outputs;
}

}  // namespace cellmirror::app
