// Whether a program listens at the address of a broker. The library for MQTT connects with a call that waits as long as
// the kernel does, which may be minutes: it is only called where this one was answered.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::mqtt {

// The first address of `host` that accepts a connection, numeric. Waits at most `each` for every address, of which at
// most 8 are tried, and as long as the system's resolver takes for the name.
[[nodiscard]] Result<std::string> answering_address(const std::string& host, std::uint16_t port, Nanoseconds each);

}  // namespace cellmirror::mqtt
