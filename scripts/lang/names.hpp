// Names that SCRIPT needs to validate a command before its execution, or without a gateway.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

// What a name in a command must be the name of.
// `branch`: a frame_node, or the cell's name for its own geometry. `volume`: the path of a node whose component has a
// voxel volume.
enum class NameKind : std::uint8_t { frame_node, robot, camera, sensor, workframe, branch, volume };

// Names and facts that checking a command needs; also offline, for `cellmirror check --cell`.
class NameDirectory {
 public:
  virtual ~NameDirectory() = default;
  // For frame_node a dotted path; an ambiguous shortened path is not known, and explain() says so.
  [[nodiscard]] virtual bool knows(NameKind kind, std::string_view name) const = 0;
  // Why an unknown name is not known: with the nearest names, or the candidates of an ambiguous one.
  [[nodiscard]] virtual Error explain(NameKind kind, std::string_view name) const = 0;
  // The kinds of the robot's joints in the order of its .mpc file; empty for an unknown robot.
  [[nodiscard]] virtual std::span<const JointKind> joints(std::string_view robot) const = 0;
  // Names of the robot's joints, same order (MASTER_SLAVE).
  [[nodiscard]] virtual std::vector<std::string> joint_names(std::string_view robot) const = 0;
  // The robot activated by ROBACT; empty if none.
  [[nodiscard]] virtual std::string_view active_robot() const = 0;
  // All names of a kind, for completion.
  [[nodiscard]] virtual std::vector<std::string> all(NameKind kind) const = 0;
};

}  // namespace cellmirror
