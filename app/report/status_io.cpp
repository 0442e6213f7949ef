#include "app/report/status_io.hpp"

#include <nlohmann/json.hpp>

namespace cellmirror::app {

using nlohmann::json;

json io_nodes_json(const CellState& cell_state) {
  json out = json::array();
  for (const IoNodeSnapshot& node : cell_state.io_nodes) {
    const JointStreamStatus status = node.stream->status();
    json details = json::object();
    for (const auto& [key, value] : status.details) details[key] = value;
    out.push_back({{"id", node.config->node_id},
                   {"endpoint", status.endpoint},
                   {"open", status.open},
                   {"condition", status.condition},
                   {"details", std::move(details)},
                   {"outputs_done", node.outputs},
                   {"output_changes", node.output_changes},
                   {"refused", node.refused},
                   {"last_refusal", node.last_refusal},
                   {"trouble", node.trouble},
                   {"last_errors", status.last_errors}});
  }
  return out;
}

}  // namespace cellmirror::app
