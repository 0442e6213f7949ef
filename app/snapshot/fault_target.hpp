// Where faults go that are ordered for nodes which answer a controller.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/ports/node_fault.hpp"
#include "rt_core/rt/fifo.hpp"

namespace cellmirror::app {

// Writer: the thread that answers requests. Reader: the thread of the nodes' channel.
using NodeFaultInlet = Fifo<NodeFaultOrder, 16>;

// The nodes of a [[device]], or an [[io_node]].
struct FaultTarget {
  std::string channel;              // as in the cell file
  std::string robot;                // of a [[device]]; empty: an [[io_node]]
  std::vector<std::uint8_t> nodes;  // numbers of the cell file
  std::shared_ptr<NodeFaultInlet> inlet = std::make_shared<NodeFaultInlet>();
};

}  // namespace cellmirror::app
