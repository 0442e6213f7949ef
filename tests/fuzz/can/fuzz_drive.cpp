// Any frames in any order into the drive's role.
#include <cstdint>
#include <cstdlib>

#include "drivers/can/cia402/drive.hpp"
#include "tests/fuzz/can/frame_source.hpp"

namespace {

struct Output : cellmirror::can::Cia402DriveOutput {
  void send(const cellmirror::CanFrame& frame) override {
    if (frame.length > 8) std::abort();
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Output output;
  can::Cia402DriveConfig config;
  config.node_id = 1;
  config.heartbeat_ms = 50;
  config.follows_targets = true;
  config.tpdos = {{.number = 1, .transmission_type = 1, .entries = {{0x6041, 0, 16}, {0x6064, 0, 32}}},
                  {.number = 2, .inhibit_time_100us = 10, .event_timer_ms = 5, .entries = {{0x606C, 0, 32}}}};
  can::Cia402Drive drive(config, output);
  Timestamp now{1'000'000'000};
  drive.power_on(now);
  FrameSource source(data, size);
  while (const auto frame = source.next(now)) {
    drive.receive(*frame, now);
    drive.advance(now);
  }
  return 0;
}
