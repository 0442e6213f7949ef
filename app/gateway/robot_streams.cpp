#include "app/gateway/robot_streams.hpp"

#include <variant>

#include "drivers/can/stream/streams.hpp"
#include "drivers/dds/dds_stream.hpp"

namespace cellmirror::app {

namespace {

struct StreamMaker {
  const Clock& clock;
  int fifo_priority;

  Result<std::unique_ptr<JointStream>> operator()(const std::monostate&) const {
    return fail("the cell file names no stream");
  }
  Result<std::unique_ptr<JointStream>> operator()(const Cia402StreamConfig& config) const {
    return can::make_cia402_stream(config, clock,
                                   {.thread_name = "can", .fifo_priority = fifo_priority, .open_channel = {}});
  }
  Result<std::unique_ptr<JointStream>> operator()(const DbcStreamConfig& config) const {
    return can::make_dbc_stream(config, clock,
                                {.thread_name = "can", .fifo_priority = fifo_priority, .open_channel = {}});
  }
  Result<std::unique_ptr<JointStream>> operator()(const DdsStreamConfig& config) const {
    return dds::make_dds_stream(config, clock);
  }
};

}  // namespace

Result<std::unique_ptr<JointStream>> make_robot_stream(const StreamConfig& config, const Clock& clock,
                                                       int fifo_priority) {
  return std::visit(StreamMaker{clock, fifo_priority}, config);
}

}  // namespace cellmirror::app
