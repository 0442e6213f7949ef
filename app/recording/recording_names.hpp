// The names that the gateway gives to what it writes into a recording beside messages, and `recording` reads.
#pragma once

#include <string_view>

namespace cellmirror::app {

// The metadata record that counts, by topic, what could not be written; the last one counts.
inline constexpr std::string_view kDropsName = "cellmirror.drops";
// Version, instance, cell and settings of the gateway that recorded.
inline constexpr std::string_view kGatewayName = "cellmirror.gateway";
// Metadata of a channel: "joint:NAME" = "ROBOT.JOINT".
inline constexpr std::string_view kJointKey = "joint:";

}  // namespace cellmirror::app
