// Reads how DDS peers are found: keys of the [dds] table of a cell file or of a wall file. Private to this folder.
#pragma once

#include <string>

#include "config/table_reader.hpp"
#include "rt_core/ports/dds_network.hpp"

namespace cellmirror {

// `discovery_servers`, `peers`, `multicast`, `link`. Errors: what is no IPv4 address with or without a port, servers
// beside peers.
[[nodiscard]] DdsNetworkConfig read_dds_network(TableReader& dds);

// The text as the name of a DDS partition: 1 to 255 printable characters without wildcards.
[[nodiscard]] std::string read_partition(TableReader& table, const char* key);

}  // namespace cellmirror
