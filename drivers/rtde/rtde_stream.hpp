// Joint streams of Universal Robots' controllers by RTDE over TCP.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/payload_sink.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::rtde {

// The stream of one robot, closed. open() starts a thread that connects, and connects again half a second after a
// connection was lost, refused or silent for as long as a value is lost. `clock` outlives the stream.
// `fifo_priority`: SCHED_FIFO of that thread, where allowed; 0: none.
// `payloads` is given each data package, without its head, by that thread.
[[nodiscard]] Result<std::unique_ptr<JointStream>> make_rtde_stream(const RtdeStreamConfig& config, const Clock& clock,
                                                                    int fifo_priority = 0,
                                                                    std::shared_ptr<PayloadSink> payloads = {});

}  // namespace cellmirror::rtde
