// Reads [[stream]] and [[device]] tables. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell_file.hpp"
#include "config/component_files.hpp"
#include "config/table_reader.hpp"

namespace cellmirror {

// `complete`: all robots of the cell are in `robots`, so that an unknown one is an error.
[[nodiscard]] std::optional<RobotStream> read_stream(TableReader& reader, const RobotDirectory& robots, bool complete,
                                                     const FileFinder& files);

// The same for [[device]].
[[nodiscard]] std::optional<RobotStream> read_device(TableReader& reader, const RobotDirectory& robots, bool complete,
                                                     const FileFinder& files);

// [[controller]]; nothing where it does not say of which robot.
[[nodiscard]] std::optional<ControllerConfig> read_controller(TableReader& reader, const RobotDirectory& robots,
                                                              bool complete);

// The robot that a table names with the key "robot"; null where it is not known, with an error where `complete`.
[[nodiscard]] const RobotFacts* find_robot(const TableReader& reader, const std::string& robot,
                                           const RobotDirectory& robots, bool complete);

// The number of a joint that a table names with the key "joint"; nothing, with an error, where it is unknown.
struct JointReference {
  std::size_t number = 0;
  std::string name;
  JointKind kind = JointKind::revolute;
};
[[nodiscard]] std::optional<JointReference> read_joint_reference(TableReader& reader, const RobotFacts* robot);

[[nodiscard]] Cia402StreamConfig read_cia402(TableReader& reader, const RobotFacts* robot, const FileFinder& files);
[[nodiscard]] DbcStreamConfig read_dbc(TableReader& reader, const RobotFacts* robot, const FileFinder& files);
[[nodiscard]] DdsStreamConfig read_dds(TableReader& reader, const RobotFacts* robot);
[[nodiscard]] RtdeStreamConfig read_rtde(TableReader& reader, const RobotFacts* robot);
[[nodiscard]] Cia402DeviceConfig read_cia402_device(TableReader& reader, const RobotFacts* robot,
                                                    const FileFinder& files);
// The [[stream.e2e]] tables.
[[nodiscard]] std::vector<E2eConfig> read_protections(TableReader& stream);
[[nodiscard]] CanChannelConfig read_channel(TableReader& reader, const FileFinder& files);
[[nodiscard]] StreamAges read_ages(TableReader& reader);
[[nodiscard]] PlausibilityConfig read_plausibility(TableReader& reader, const StreamAges& ages);
// The DDS name of a topic; "/joint_states" is ROS 2's way to write rt/joint_states. A DDS name without "rt/" is warned
// of, since no ROS 2 topic has it. Empty where the text is empty.
[[nodiscard]] std::optional<std::string> read_topic(TableReader& reader, std::string_view key);
// An IPv4 or IPv6 address as text, numeric.
[[nodiscard]] bool is_address(std::string_view text);
// Returns true if an interface of this machine has the numeric address now, or the address means all interfaces
// (0.0.0.0, ::).
[[nodiscard]] bool is_own_address(const std::string& address);
// Reads an address of this machine: an error if it is not numeric, a warning if no interface has it now. Returns
// nothing if the key is missing or refused.
[[nodiscard]] std::optional<std::string> read_own_address(TableReader& reader, std::string_view key);
// Seconds in the key, within 0 and `max`; the value as nanoseconds.
[[nodiscard]] std::optional<Nanoseconds> read_seconds(TableReader& reader, std::string_view key, double max,
                                                      bool zero_allowed);

}  // namespace cellmirror
