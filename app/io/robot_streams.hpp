// Makes the stream that a cell file describes, by the driver of its kind.
#pragma once

#include <memory>

#include "app/snapshot/contact_inlet.hpp"
#include "app/snapshot/fault_target.hpp"
#include "config/cell_file.hpp"
#include "drivers/can/stream/streams.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/payload_sink.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

// What a stream is given beside its description; what its kind does not need stays empty.
struct StreamLinks {
  can::ChannelOpener open_can = {};                         // of CAN streams; empty: as their endpoints say
  std::shared_ptr<can::SharedChannel> device_channel = {};  // of a [[device]], which needs it
  std::shared_ptr<PayloadSink> payloads = {};               // is given what DDS and RTDE streams receive
  std::shared_ptr<ContactInlet> contacts = {};              // of the robot, for the drives of its [[device]]
  std::shared_ptr<NodeFaultInlet> faults = {};              // likewise
};

// Closed; `clock` outlives it. `fifo_priority`: of the threads of CAN streams, 0 for none; frames then reach the tick
// also while the machine is busy with other things. Fails for what can never work, e.g. a DBC file without the signal
// that the cell names.
Result<std::unique_ptr<JointStream>> make_robot_stream(const StreamConfig& config, const Clock& clock,
                                                       int fifo_priority, const StreamLinks& links = {});

// Reads the EDS, DCF or DBC files of the stream and tells what is wrong with them and with what the cell file takes
// from them, each at its place; warns of joints without a source. What the reader of the cell file told is not told
// again.
void check_robot_stream(const RobotStream& stream, Diagnostics& diagnostics);

}  // namespace cellmirror::app
