// Checks the node numbers of drives and I/O nodes that answer on one CAN channel. Private to this folder.
#pragma once

#include <span>

#include "config/cell_file.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/io_config.hpp"

namespace cellmirror {

// An error where two tables give the same number to a node of the same channel: both would answer. Two of one
// [[device]], and two I/O nodes, were told by the readers of these tables.
void check_node_numbers(std::span<const RobotStream> streams, std::span<const IoNodeConfig> io_nodes,
                        Diagnostics& diagnostics);

}  // namespace cellmirror
