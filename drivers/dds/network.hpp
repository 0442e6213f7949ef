// How this process finds its DDS peers.
#pragma once

#include "rt_core/ports/dds_network.hpp"

namespace cellmirror::dds {

// Of participants that are made from now on. Any thread.
void set_network(const DdsNetworkConfig& network);

}  // namespace cellmirror::dds
