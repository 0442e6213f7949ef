// What a wall knows of its cells, in Prometheus' text format.
#pragma once

#include <string>

#include "app/wall/wall_cells.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::app {

// Each cell has the labels cell, host, instance and claim: claim counts from 1 where two gateways name all three alike.
[[nodiscard]] std::string wall_metrics(const WallCells& cells, const web::ServerStatus& web, Timestamp now);

}  // namespace cellmirror::app
