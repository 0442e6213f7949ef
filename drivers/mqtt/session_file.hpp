// The number of the last Sparkplug session (bdSeq), which outlives the gateway: the last will of an earlier run, which
// a broker may deliver late, must not end the session of this one (specification 3.0.0, 6.4.1).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::mqtt {

// Returns none if the file does not exist. Fails if it cannot be read or does not contain a number from 0 to 255.
[[nodiscard]] Result<std::optional<std::uint8_t>> read_session(const std::string& file);
// Replaces the file whole, with mode 0600.
[[nodiscard]] Result<void> write_session(const std::string& file, std::uint8_t session);

}  // namespace cellmirror::mqtt
