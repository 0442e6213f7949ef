// Who on a channel takes a frame, by its identifier. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// One node of one member of a channel; both are numbered from 0.
struct CanListener {
  std::uint16_t member = 0;
  std::uint16_t node = 0;
  bool operator==(const CanListener&) const = default;
};

class IdentifierRoutes {
 public:
  // Nobody takes anything.
  void clear();
  // The listener takes frames with these 11-bit identifiers; others are left out. Not twice for a listener.
  void add(CanListener listener, std::span<const std::uint32_t> identifiers);
  // The listener takes every frame, also those with 29 bits.
  void add_all(CanListener listener) { all_.push_back(listener); }
  // After the last add(): what of() tells from now on.
  void build();

  // In the order of add(), then of add_all(). Valid until build().
  [[nodiscard]] std::span<const CanListener> of(const CanFrame& frame) const;

 private:
  static constexpr std::size_t kIdentifiers = 0x800;

  struct Route {
    std::uint32_t identifier = 0;
    CanListener listener;
  };

  std::vector<Route> routes_;
  std::vector<CanListener> all_;
  // As build() has found them: those of an identifier one after the other, and where they begin; the last are `all_`.
  std::vector<CanListener> listeners_;
  std::array<std::uint32_t, kIdentifiers + 2> first_{};
};

}  // namespace cellmirror::can
