#include "app/io/robot_streams.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "drivers/can/stream/streams.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/rtde/rtde_stream.hpp"

namespace cellmirror::app {

namespace {

struct StreamMaker {
  const Clock& clock;
  int fifo_priority;
  const StreamLinks& links;

  Result<std::unique_ptr<JointStream>> operator()(const std::monostate&) const {
    return fail("the cell file names no stream");
  }
  Result<std::unique_ptr<JointStream>> operator()(const Cia402StreamConfig& config) const {
    return can::make_cia402_stream(
        config, clock, {.thread_name = "can", .fifo_priority = fifo_priority, .open_channel = links.open_can});
  }
  Result<std::unique_ptr<JointStream>> operator()(const DbcStreamConfig& config) const {
    return can::make_dbc_stream(config, clock,
                                {.thread_name = "can", .fifo_priority = fifo_priority, .open_channel = links.open_can});
  }
  Result<std::unique_ptr<JointStream>> operator()(const Cia402DeviceConfig& config) const {
    return can::make_cia402_device(config, clock, links.device_channel, links.contacts, links.faults);
  }
  Result<std::unique_ptr<JointStream>> operator()(const DdsStreamConfig& config) const {
    return dds::make_dds_stream(config, clock, links.payloads);
  }
  Result<std::unique_ptr<JointStream>> operator()(const RtdeStreamConfig& config) const {
    return rtde::make_rtde_stream(config, clock, fifo_priority, links.payloads);
  }
};

struct TableOfAJoint {
  const char* operator()(const std::monostate&) const { return ""; }
  const char* operator()(const DdsStreamConfig&) const { return "joint"; }
  const char* operator()(const RtdeStreamConfig&) const { return "joint"; }
  const char* operator()(const Cia402StreamConfig&) const { return "node"; }
  const char* operator()(const DbcStreamConfig&) const { return "signal"; }
  const char* operator()(const Cia402DeviceConfig&) const { return "node"; }
};

struct StreamChecker {
  Diagnostics& found;

  void operator()(const std::monostate&) const {}
  void operator()(const DdsStreamConfig&) const {}
  void operator()(const RtdeStreamConfig&) const {}
  void operator()(const Cia402DeviceConfig&) const {}
  void operator()(const Cia402StreamConfig& config) const { can::check_stream(config, found); }
  void operator()(const DbcStreamConfig& config) const { can::check_stream(config, found); }
};

}  // namespace

void check_robot_stream(const RobotStream& stream, Diagnostics& diagnostics) {
  Diagnostics found;
  const char* table = std::holds_alternative<Cia402DeviceConfig>(stream.config) ? "device" : "stream";
  if (const auto& joints = stream.joints_without_position; !joints.empty()) {
    const bool one = joints.size() == 1;
    found.warning(stream.place,
                  fmt::format("nothing gives the position of {}; {}", fmt::join(joints, ", "),
                              one ? "it stays at its start position" : "they stay at their start positions"),
                  fmt::format("add a [[{}.{}]]", table, std::visit(TableOfAJoint{}, stream.config)));
  }
  std::visit(StreamChecker{found}, stream.config);
  for (Diagnostic diagnostic : found.all()) {
    diagnostic.message = fmt::format("{} of {}: {}", table, stream.robot, diagnostic.message);
    diagnostics.add(std::move(diagnostic));
  }
}

Result<std::unique_ptr<JointStream>> make_robot_stream(const StreamConfig& config, const Clock& clock,
                                                       int fifo_priority, const StreamLinks& links) {
  return std::visit(StreamMaker{clock, fifo_priority, links}, config);
}

}  // namespace cellmirror::app
