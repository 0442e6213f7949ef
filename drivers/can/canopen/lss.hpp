// Layer setting services as a slave has them (CiA 305): a master chooses one by its identity, or all, asks for identity
// and node number, gives another node number, and finds nodes that have none. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

inline constexpr std::uint32_t kLssMasterCobId = 0x7E5;
inline constexpr std::uint32_t kLssSlaveCobId = 0x7E4;

// The number of a node that waits for one (CiA 305): it takes no part in anything but layer setting services.
inline constexpr std::uint8_t kNoNodeNumber = 0xFF;

class LssSlave {
 public:
  // Vendor, product code, revision number, serial number: object 0x1018.
  using Identity = std::array<std::uint32_t, 4>;

  explicit LssSlave(std::uint8_t node) : pending_(node) {}

  struct Reaction {
    std::optional<CanFrame> answer;
    bool starts = false;  // a node without a number has got one, and resets its communication by itself
  };

  // What follows from a frame of the master; nothing from frames of other services. `node`: the number that is in
  // force.
  [[nodiscard]] Reaction receive(const CanFrame& frame, const Identity& identity, std::uint8_t node);
  // The number that comes into force with the next NMT reset communication.
  [[nodiscard]] std::uint8_t pending() const { return pending_; }
  // NMT reset: waits to be chosen again; the number that is in force is `node`.
  void restart(std::uint8_t node) { *this = LssSlave(node); }

 private:
  using Answer = std::optional<CanFrame>;

  [[nodiscard]] bool switch_all(std::uint8_t mode, std::uint8_t node);
  [[nodiscard]] Answer select(std::size_t part, std::uint32_t number, const Identity& identity);
  [[nodiscard]] Answer identify(std::size_t part, std::uint32_t number, const Identity& identity);
  [[nodiscard]] Answer scan(const CanFrame& frame, const Identity& identity);
  [[nodiscard]] Answer configure(const CanFrame& frame, const Identity& identity, std::uint8_t node);

  std::uint8_t pending_;
  bool configuring_ = false;
  std::size_t matched_ = 0;     // parts of the identity that were named one after the other
  std::size_t identified_ = 0;  // bounds of the identity that were met one after the other
  std::size_t scanned_ = 0;     // the part of the identity that the scan is at
};

}  // namespace cellmirror::can
