#include "app/gateway/robot_streams.hpp"

#include <variant>

#include "drivers/can/stream/streams.hpp"
#include "drivers/dds/dds_stream.hpp"

namespace cellmirror::app {

namespace {

struct StreamMaker {
  const Clock& clock;

  Result<std::unique_ptr<JointStream>> operator()(const std::monostate&) const {
    return fail("the cell file names no stream");
  }
  Result<std::unique_ptr<JointStream>> operator()(const Cia402StreamConfig& config) const {
    return can::make_cia402_stream(config, clock);
  }
  Result<std::unique_ptr<JointStream>> operator()(const DbcStreamConfig& config) const {
    return can::make_dbc_stream(config, clock);
  }
  Result<std::unique_ptr<JointStream>> operator()(const DdsStreamConfig& config) const {
    return dds::make_dds_stream(config, clock);
  }
};

}  // namespace

Result<std::unique_ptr<JointStream>> make_robot_stream(const StreamConfig& config, const Clock& clock) {
  return std::visit(StreamMaker{clock}, config);
}

}  // namespace cellmirror::app
