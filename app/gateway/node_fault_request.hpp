// The request {"request":"fault", ...} of the control socket: faults of nodes that answer a controller.
#pragma once

#include <string>
#include <string_view>

#include "ipc/control/control_request.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/node_fault.hpp"

namespace cellmirror::app {

// KIND[:key=value[,key=value...]], e.g. "delay:s=0.2,only=sdo". Says what is wrong with any other text.
[[nodiscard]] Result<NodeFault> parse_node_fault(std::string_view text);

// Members: node (1 to 127); fault, a text as above, or end (true); for_s: how long it lasts, else until it is ended;
// channel: of the node, where several have the number.
struct FaultRequest {
  NodeFaultOrder order;
  std::string channel;  // empty: any
};
[[nodiscard]] Result<FaultRequest> fault_request(const ControlRequest& request);

}  // namespace cellmirror::app
