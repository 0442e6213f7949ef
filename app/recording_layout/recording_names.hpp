// The names that the gateway gives to what it writes into a recording beside messages, and `recording` reads.
#pragma once

#include <string_view>

namespace cellmirror::app {

// The metadata record that counts, by topic, what could not be written; the last one counts.
inline constexpr std::string_view kDropsName = "cellmirror.drops";
// Version, instance, cell and settings of the gateway that recorded.
inline constexpr std::string_view kGatewayName = "cellmirror.gateway";
// In that: the program and the instruction set that it computes with; with others a replay differs in the last bits.
inline constexpr std::string_view kBuildKey = "build";
inline constexpr std::string_view kTargetKey = "target";
// UTC minus the instants of the machine's monotonic clock, ns, when the recording began.
inline constexpr std::string_view kUtcKey = "utc_minus_monotonic_ns";
// Where the cell file was.
inline constexpr std::string_view kCellFileKey = "cell_file";
// Which files of the cell are attached: kCellFileRoot = the cell file's place in its folder, and for each file
// kCellFileListed + PLACE = kAttached, kSameAs + PLACE of one with the same content, or kLeftOut + why.
inline constexpr std::string_view kCellFilesName = "cellmirror.cell_files";
inline constexpr std::string_view kCellFileRoot = "cell";
inline constexpr std::string_view kCellFileListed = "file:";
inline constexpr std::string_view kAttached = "attached";
inline constexpr std::string_view kSameAs = "same as ";
inline constexpr std::string_view kLeftOut = "left out: ";
inline constexpr std::string_view kJointsTopic = "/joint_states";
inline constexpr std::string_view kAlarmsTopic = "/cellmirror/alarms";
inline constexpr std::string_view kCollisionEventsTopic = "/cellmirror/collision_events";
inline constexpr std::string_view kTissueEventsTopic = "/cellmirror/tissue_events";
// The topic that has all that the tick took (docs/recording.md).
inline constexpr std::string_view kInputsTopic = "/inputs/ticks";
inline constexpr std::string_view kInputsEncoding = "cellmirror.inputs";
// Surfaces of deformable objects, one topic each, and what is beside surfaces (tissue_messages.hpp).
inline constexpr std::string_view kTissueTopics = "/cellmirror/tissue";
inline constexpr std::string_view kTissueEncoding = "cellmirror.tissue";
inline constexpr std::string_view kTissueEffectsTopic = "/cellmirror/tissue_effects";
inline constexpr std::string_view kTissueEffectsEncoding = "cellmirror.tissue_effects";
// Metadata of a channel: "joint:NAME" = "ROBOT.JOINT".
inline constexpr std::string_view kJointKey = "joint:";

}  // namespace cellmirror::app
