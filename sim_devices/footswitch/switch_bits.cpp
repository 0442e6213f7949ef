#include "sim_devices/footswitch/switch_bits.hpp"

#include <array>

#include "ipc/wire/shared_words.hpp"

namespace cellmirror::sim {

std::size_t bytes_for(std::uint32_t input) { return (input + 7U) / 8U; }

std::size_t put_switches(std::span<std::byte> memory, std::span<const SwitchChange> changes) {
  struct Masks {
    std::uint8_t set = 0;
    std::uint8_t clear = 0;
  };
  std::array<Masks, kMaxSwitches / 8> bytes{};
  std::size_t left_out = 0;
  for (const SwitchChange& change : changes) {
    const std::size_t index = (change.input - 1U) / 8U;
    if (change.input == 0 || index >= memory.size() || index >= bytes.size()) {
      ++left_out;
      continue;
    }
    const auto bit = static_cast<std::uint8_t>(1U << ((change.input - 1U) % 8U));
    // The last word on a bit counts.
    Masks& masks = bytes[index];
    masks.set = static_cast<std::uint8_t>(change.on ? masks.set | bit : masks.set & ~bit);
    masks.clear = static_cast<std::uint8_t>(change.on ? masks.clear & ~bit : masks.clear | bit);
  }
  for (std::size_t i = 0; i < bytes.size() && i < memory.size(); ++i) {
    const Masks masks = bytes[i];
    if ((masks.set | masks.clear) == 0) continue;
    // Turned round rather than stored: what others do to other bits meanwhile stays.
    const auto byte = shared_words::at<std::uint8_t>(memory, i);
    const unsigned old = byte.load();
    byte.fetch_xor(static_cast<std::uint8_t>((old & masks.clear) | (~old & masks.set)));
  }
  return left_out;
}

}  // namespace cellmirror::sim
