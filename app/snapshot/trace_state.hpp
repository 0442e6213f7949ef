// Traces of TCPs, from the worker that records them to pictures and status.
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/ports/tcp_trace.hpp"

namespace cellmirror::app {

struct TraceState {
  std::uint64_t smear_ends = 0;  // as DisplayState::smear_ends: traces of before the mode was off are none any more
  std::vector<TcpTrace> traces;  // the robot that was active last comes last
};

}  // namespace cellmirror::app
