// A master at one drive, by hand: SDO frames, NMT, and time in small steps.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/cia402/device/servo_drive.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {

using namespace std::chrono_literals;

// 1000 increments a rad, so that figures are easy to read; 1 kg m2.
inline DriveConfig test_drive() {
  DriveConfig config;
  config.node_id = 5;
  config.encoder_increments = 1000;
  config.unit_per_shaft = 1;
  config.software_limits = {-30, 30};
  config.stops = JointInterval{-31, 31};
  config.velocity = 10;
  config.acceleration = 100;
  config.rated_torque = 100;
  config.following_error = 0.5;
  return config;
}

struct DriveMaster : FrameOutput {
  explicit DriveMaster(const DriveConfig& config = test_drive()) : drive(config, 0, *this) { drive.power_on(now); }

  void send(const CanFrame& sent) override { frames.push_back(sent); }
  std::vector<CanFrame> take() { return std::exchange(frames, {}); }

  void run(Nanoseconds time) {
    for (const Timestamp end = now + time; now < end;) {
      now = now + 500us;
      drive.advance(now);
    }
  }
  void receive(const CanFrame& frame) { drive.receive(frame, now); }

  // Of the predefined sizes by `bytes`; the abort code, 0 where the write was taken.
  std::uint32_t write(std::uint16_t index, std::uint8_t subindex, std::int64_t value, std::size_t bytes) {
    CanFrame request = frame(0x605, {static_cast<int>(0x23 | (4 - bytes) << 2), 0, 0, subindex, 0, 0, 0, 0});
    put_le(std::span(request.data).subspan(1), index, 2);
    put_le(std::span(request.data).subspan(4), static_cast<std::uint64_t>(value), bytes);
    take();
    receive(request);
    return answer_abort();
  }
  std::uint32_t write16(std::uint16_t index, std::int64_t value) { return write(index, 0, value, 2); }
  std::uint32_t write32(std::uint16_t index, std::int64_t value) { return write(index, 0, value, 4); }
  std::uint32_t read_abort(std::uint16_t index, std::uint8_t subindex) {
    CanFrame request = frame(0x605, {0x40, 0, 0, subindex, 0, 0, 0, 0});
    put_le(std::span(request.data).subspan(1), index, 2);
    take();
    receive(request);
    return answer_abort();
  }
  std::uint32_t answer_abort() {
    for (const CanFrame& sent : frames) {
      if (sent.id == 0x585 && sent.data[0] == 0x80) return get_le32(std::span(sent.data).subspan(4));
    }
    return 0;
  }

  void control(std::uint16_t word) { EXPECT_EQ(write16(0x6040, word), 0U); }
  void mode(int mode) { EXPECT_EQ(write(0x6060, 0, mode, 1), 0U); }
  void enable() {
    run(1ms);
    control(0x06);
    control(0x07);
    control(0x0F);
    ASSERT_EQ(drive.state(), Cia402State::operation_enabled);
  }
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t subindex = 0) const {
    return drive.objects().integer({index, subindex}).value_or(-1);
  }
  [[nodiscard]] bool status(int bit) const { return (object(0x6041) >> bit & 1) != 0; }
  // Until the bit of the statusword is set; false where it is not within `longest`.
  bool run_until(int bit, Nanoseconds longest) {
    for (const Timestamp end = now + longest; now < end && !status(bit);) run(500us);
    return status(bit);
  }
  std::vector<std::uint16_t> emergencies() {
    std::vector<std::uint16_t> codes;
    for (const CanFrame& sent : frames) {
      if (sent.id == 0x085) codes.push_back(get_le16(sent.data));
    }
    return codes;
  }

  std::vector<CanFrame> frames;
  Timestamp now{1'000'000'000};
  ServoDrive drive;
};

}  // namespace cellmirror::can
