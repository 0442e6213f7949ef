// What a broker or the library says, with what the user can do about it.
#pragma once

#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::mqtt {

// The answer to CONNECT: MQTT 5 (3.2.2.2), or 3.1.1 (3.2.2.3) with `old_protocol`.
[[nodiscard]] Error connect_refused(int code, bool old_protocol);
// A code of DISCONNECT (3.14.2.1) or of the library. `details`: what the library has logged; may be empty.
[[nodiscard]] Error connection_lost(int code, const std::string& details);

}  // namespace cellmirror::mqtt
