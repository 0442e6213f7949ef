// How faults strike CAN frames.
#pragma once

#include <algorithm>
#include <optional>

#include "rt_core/ports/can_channel.hpp"
#include "sim_devices/faults/fault_pipeline.hpp"

namespace cellmirror::sim {

template <>
struct FaultTraits<CanFrame> {
  // Bits of the data; a frame without data gets another identifier instead.
  static void flip_bits(CanFrame& frame, unsigned bits, Random& random) {
    if (frame.length == 0) return change_identity(frame, std::nullopt, random);
    for (unsigned i = 0; i < bits; ++i) {
      const auto bit = random.below(8ULL * frame.length);
      frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << (bit % 8)));
    }
  }

  static void change_identity(CanFrame& frame, std::optional<std::uint32_t> id, Random& random) {
    const std::uint32_t range = frame.extended ? 1U << 29U : 1U << 11U;
    if (id) {
      frame.extended = frame.extended || *id >= (1U << 11U);
      frame.id = *id;
    } else {
      // Never its own; not 0 either, which is NMT.
      const auto lot = 1 + static_cast<std::uint32_t>(random.below(range - 2));
      frame.id = lot >= frame.id && frame.id != 0 ? lot + 1 : lot;
    }
  }

  // Within the lengths that the frame's format has.
  static void change_length(CanFrame& frame, int by) {
    const int longest = frame.fd ? static_cast<int>(kCanMaxData) : 8;
    const int length = std::clamp(static_cast<int>(frame.length) + by, 0, longest);
    frame.length = frame.fd ? fd_length(length) : static_cast<std::uint8_t>(length);
    std::fill(frame.data.begin() + frame.length, frame.data.end(), std::uint8_t{0});
  }

  static CanFrame foreign(std::optional<std::uint32_t> id, Random& random) {
    CanFrame frame;
    frame.id = id.value_or(1 + static_cast<std::uint32_t>(random.below(0x7FF)));
    frame.extended = frame.id > 0x7FF;
    frame.length = static_cast<std::uint8_t>(random.below(9));
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(random.bits());
    return frame;
  }

  // linux/can/error.h: CAN_ERR_BUSOFF, CAN_ERR_RESTARTED; error frames have 8 bytes of data.
  static CanFrame bus_off() { return error_frame(0x40); }
  static CanFrame bus_restarted() { return error_frame(0x100); }

 private:
  static CanFrame error_frame(std::uint32_t classes) {
    CanFrame frame;
    frame.id = classes;
    frame.error = true;
    frame.length = 8;
    return frame;
  }

  static std::uint8_t fd_length(int length) {
    constexpr std::array<int, 7> kLengths{12, 16, 20, 24, 32, 48, 64};
    if (length <= 8) return static_cast<std::uint8_t>(length);
    return static_cast<std::uint8_t>(*std::lower_bound(kLengths.begin(), kLengths.end(), length));
  }
};

}  // namespace cellmirror::sim
