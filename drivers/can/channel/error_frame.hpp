// What an error frame of SocketCAN says (linux/can/error.h): the state of the bus, and words for people.
#pragma once

#include <optional>
#include <string>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// The state that the frame tells; none where it tells none (a lost arbitration, a missing acknowledgement, ...).
[[nodiscard]] std::optional<CanBusState> bus_state_of_error(const CanFrame& frame);
// "bus-off", "controller: receive overflow, error passive", ...
[[nodiscard]] std::string error_words(const CanFrame& frame);
// "active", "warning", "error passive", "bus-off", "down", "unknown".
[[nodiscard]] const char* words(CanBusState state);

}  // namespace cellmirror::can
