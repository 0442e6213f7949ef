// Joint streams over CAN, ready to use: a channel, a protocol session and a thread of their own each; nodes that the
// gateway answers for share channel and thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/io_image.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/node_fault.hpp"
#include "rt_core/ports/robot_contacts.hpp"
#include "rt_core/ports/stream_config.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::can {

using ChannelOpener = std::function<Result<std::unique_ptr<CanChannel>>(const CanChannelConfig&)>;

struct CanStreamOptions {
  std::string thread_name = "can";  // at most 15 bytes are shown by the system
  int fifo_priority = 0;            // > 0: SCHED_FIFO with this priority where the machine allows it
  ChannelOpener open_channel;       // empty: open_can_channel() with WhereMissing::wait; tests use a virtual bus
};

// Reads and checks the EDS, DCF or DBC files now; the channel is opened by open(). Fails with all errors found.
// `clock` outlives the stream. Latency from a frame's arrival to the sample in the sink: microseconds after the wake-up
// of the stream's thread, which blocks in poll; SYNC is produced by the poll's timeout.
[[nodiscard]] Result<std::unique_ptr<JointStream>> make_cia402_stream(const Cia402StreamConfig& config,
                                                                      const Clock& clock,
                                                                      CanStreamOptions options = {});
[[nodiscard]] Result<std::unique_ptr<JointStream>> make_dbc_stream(const DbcStreamConfig& config, const Clock& clock,
                                                                   CanStreamOptions options = {});

// A channel and its thread, for any number of the nodes below. All of them see each other's frames, as on a bus. Open
// while one of its streams is. `clock` outlives it.
class SharedChannel;
[[nodiscard]] std::shared_ptr<SharedChannel> make_shared_channel(const CanChannelConfig& config, const Clock& clock,
                                                                 CanStreamOptions options = {});

// From who orders faults of nodes to the thread that answers for them; read in each period. Orders that are there when
// the nodes are switched on are forgotten.
using NodeFaultInlet = Fifo<NodeFaultOrder, 16>;

// The gateway answers as the drives of the robot; the samples are where the drives have moved it. SYNC is answered by
// the thread that received it, before the drives move on. `config` is as the reader of the cell file leaves it; its
// channel is that of `channel`. `contacts`: what the robot touches, read by the channel's thread; null: nothing ever.
// `faults` may be null.
[[nodiscard]] Result<std::unique_ptr<JointStream>> make_cia402_device(
    const Cia402DeviceConfig& config, const Clock& clock, std::shared_ptr<SharedChannel> channel,
    std::shared_ptr<Latest<RobotContacts>> contacts = {}, std::shared_ptr<NodeFaultInlet> faults = {});

// Between the thread of an I/O node and the gateway.
struct IoLinks {
  std::shared_ptr<Latest<IoInputs>> inputs;     // the node reads
  std::shared_ptr<Latest<IoOutputs>> outputs;   // the node writes, where they change
  std::function<void()> outputs_changed;        // then, on the channel's thread; must not wait
  std::shared_ptr<NodeFaultInlet> faults = {};  // the node reads; null: there are none
};
// The gateway answers as a CiA 401 I/O node on `channel`, which is that of `config`. It gives no samples: open it with
// no_samples().
[[nodiscard]] std::unique_ptr<JointStream> make_cia401_node(const IoNodeConfig& config, IoLinks links,
                                                            const Clock& clock, std::shared_ptr<SharedChannel> channel);
[[nodiscard]] JointSampleSink& no_samples();

// Everything that would keep such a stream from being made, and what makes its values doubtful, at its place in the
// cell file or in the EDS, DCF or DBC file. What the reader of the cell file refused (empty names, no node, twice the
// same) is left out: it was reported.
void check_stream(const Cia402StreamConfig& config, Diagnostics& diagnostics);
void check_stream(const DbcStreamConfig& config, Diagnostics& diagnostics);

}  // namespace cellmirror::can
