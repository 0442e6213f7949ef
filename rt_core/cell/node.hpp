// A node of the cell's tree.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/component.hpp"
#include "rt_core/cell/robot_model.hpp"

namespace cellmirror {

// What drives a joint node.
struct JointBinding {
  std::uint8_t slot = 0;
  std::uint8_t joint = 0;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct Node {
  std::string name;
  NodeId parent = kNoNode;             // in the tree of names; never changes
  NodeId predecessor = kNoNode;        // kinematic; changed by CONNECT and FRAME_TO_WFRM
  NodeId first_predecessor = kNoNode;  // at the start
  Pose X_PF = Pose::Identity();        // in the predecessor, at joint position zero
  std::vector<NodeId> children;        // in the tree of names
  std::shared_ptr<const Component> declared_in;
  const ComponentNode* definition = nullptr;  // in declared_in
  std::shared_ptr<const Component> content;   // of its ABSTRACT file; null: none, or not in memory
  Shown shown = Shown::detail;
  JointBinding binding;     // kind joint
  CameraDefinition camera;  // kind camera
  SensorDefinition sensor;  // kind sensor

  [[nodiscard]] NodeKind kind() const { return definition->kind; }
  [[nodiscard]] bool has_abstract() const { return definition->abstract.has_value(); }
};

}  // namespace cellmirror
