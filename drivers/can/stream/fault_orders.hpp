// Faults of nodes as they were ordered, and in words.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/node_fault.hpp"

namespace cellmirror::can {

// `node`: a ServoDrive or an IoNode.
template <class Node>
void carry_out(const NodeFaultOrder& order, Node& node, Timestamp now) {
  if (order.ends_all) {
    node.end_faults(now);
  } else {
    node.inject(order.fault, now);
  }
}

inline void forget_orders(NodeFaultInlet* inlet) {
  NodeFaultOrder order;
  while (inlet != nullptr && inlet->pop(order)) continue;
}

// `kinds`: FaultGate::kinds(). E.g. "delay, stuck".
[[nodiscard]] inline std::string fault_words(std::uint8_t kinds) {
  std::string out;
  for (std::size_t i = 0; i < kNodeFaultNames.size(); ++i) {
    if ((kinds >> i & 1U) == 0) continue;
    if (!out.empty()) out += ", ";
    out += kNodeFaultNames.at(i);
  }
  return out;
}

}  // namespace cellmirror::can
