// Layer setting services as a slave has them (CiA 305): a master chooses one by its identity, or all, asks for identity
// and node number, and gives another node number. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

inline constexpr std::uint32_t kLssMasterCobId = 0x7E5;
inline constexpr std::uint32_t kLssSlaveCobId = 0x7E4;

class LssSlave {
 public:
  // Vendor, product code, revision number, serial number: object 0x1018.
  using Identity = std::array<std::uint32_t, 4>;

  explicit LssSlave(std::uint8_t node) : pending_(node) {}

  // The answer to a frame of the master; none for frames of other services. `node`: the number that is in force.
  [[nodiscard]] std::optional<CanFrame> receive(const CanFrame& frame, const Identity& identity, std::uint8_t node);
  // The number that comes into force with the next NMT reset communication.
  [[nodiscard]] std::uint8_t pending() const { return pending_; }
  // NMT reset: waits to be chosen again; the number that is in force is `node`.
  void restart(std::uint8_t node) { pending_ = node, configuring_ = false, matched_ = 0; }

 private:
  [[nodiscard]] std::optional<CanFrame> select(std::size_t part, std::uint32_t number, const Identity& identity);
  [[nodiscard]] std::optional<CanFrame> configure(const CanFrame& frame, const Identity& identity, std::uint8_t node);

  std::uint8_t pending_;
  bool configuring_ = false;
  std::size_t matched_ = 0;  // parts of the identity that were named one after the other
};

}  // namespace cellmirror::can
