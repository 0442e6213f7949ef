// Any frames in any order to a drive that the gateway answers for, with its motor, which touches something at times,
// and to one beside it that waits for its number (LSS).
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/can/cia402/device/servo_drive.hpp"
#include "tests/fuzz/can/checked_output.hpp"
#include "tests/fuzz/can/frame_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  CheckedOutput output;
  DriveConfig config;
  config.node_id = 1;
  config.stops = JointInterval{-3, 3};
  config.limit_switches = JointInterval{-2.5, 2.5};
  config.home_switch = JointInterval{0.5, 0.6};
  can::ServoDrive drive(config, 50, output);
  DriveConfig without_number = config;
  without_number.waits_for_lss = true;
  can::ServoDrive waiting(without_number, 50, output);
  Timestamp now{1'000'000'000};
  drive.power_on(now);
  waiting.power_on(now);
  FrameSource source(data, size);
  while (const auto frame = source.next(now)) {
    receive_checked(drive, output, *frame, now);
    drive.set_bounds(
        {.lower = (frame->data[0] & 1U) != 0 ? 0.0 : -1e9, .upper = (frame->data[0] & 2U) != 0 ? 0.0 : 1e9});
    drive.advance(now);
    waiting.receive(*frame, now);
    waiting.advance(now);
    if (!std::isfinite(drive.joint_position()) || std::abs(drive.joint_position()) > 3) std::abort();
  }
  return 0;
}
