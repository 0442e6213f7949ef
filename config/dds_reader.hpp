// Reads [dds] and [dds.security] of a cell file. Private to this folder.
#pragma once

#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

// Security is not enabled without its table. `ros`: what [dds] says of ROS 2; `network`: how peers
// are found. Errors: files that are missing or outside
// of the cell folder; a private key that others may read.
[[nodiscard]] DdsSecurityConfig read_dds(TableReader& top, const FileFinder& files, RosPresence& ros,
                                         DdsNetworkConfig& network);

}  // namespace cellmirror
