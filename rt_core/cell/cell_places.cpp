// Where things are: SET_FRAME PLACEMENT, CONNECT, FRAME_TO_WFRM, SET_CAMPAR.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "rt_core/base/units.hpp"
#include "rt_core/cell/cell_state.hpp"

namespace cellmirror {

namespace {

constexpr double kFarthest = 1e6;  // m; beyond it a double no longer resolves a nanometre

// Conditions for attaching a part to a predecessor.
Result<void> check_connection(const Cell::State& state, NodeId part, NodeId predecessor) {
  const std::string name = state.names.path(part);
  if (state.at(part).kind() == NodeKind::joint)
    return fail(fmt::format("{} is a joint and cannot leave its mechanism", name),
                "connect the frame of the component instead");
  if (const RobotModel* robot = state.robot_of_mechanism(part); robot != nullptr && robot->base() != part) {
    return fail(fmt::format("{} is part of the mechanism of the robot {}", name, robot->id()),
                fmt::format("connect {} instead", state.names.path(robot->component())));
  }
  if (state.at(part).shown == Shown::coarse) {
    return fail(fmt::format("{} is shown by the geometry of its father, which cannot be moved", name),
                fmt::format("SWAP_NODE {} first", name));
  }
  if (part == predecessor) return fail(fmt::format("{} cannot be its own predecessor", name));
  if (state.is_below(predecessor, part)) {
    return fail(
        fmt::format("{} is attached to {} and cannot become its predecessor", state.names.path(predecessor), name));
  }
  return {};
}

}  // namespace

Result<void> Cell::set_placement(std::string_view path, const Pose& X_PF) {
  const auto id = state_->find(path);
  if (!id) return std::unexpected(id.error());
  Node& node = state_->at(*id);
  if (node.kind() == NodeKind::joint) {
    return fail(fmt::format("{} is a joint; its mechanism defines its pose", state_->names.path(*id)),
                "POS_ROB moves joints");
  }
  if (!X_PF.matrix().allFinite())
    return fail(fmt::format("the placement of {} is not finite", state_->names.path(*id)));
  if (const double distance = X_PF.translation().norm(); distance > kFarthest) {
    return fail(fmt::format("the placement of {} is {:.10g} mm away from its predecessor, but at most {:.10g} mm",
                            state_->names.path(*id), mm_from_m(distance), mm_from_m(kFarthest)));
  }
  node.X_PF = X_PF;
  state_->changed();
  return {};
}

Result<void> Cell::connect(std::string_view part, std::string_view predecessor, std::span<const JointValues> q) {
  const auto f2 = state_->find(part);
  if (!f2) return std::unexpected(f2.error());
  const auto f1 = state_->find(predecessor);
  if (!f1) return std::unexpected(f1.error());
  if (auto checked = check_connection(*state_, *f2, *f1); !checked) return checked;
  const Pose X_W2 = world_pose(*f2, q);
  const Pose X_W1 = world_pose(*f1, q);
  Node& node = state_->at(*f2);
  node.X_PF = X_W1.inverse() * X_W2;
  node.predecessor = *f1;
  state_->changed_structure();
  return {};
}

Result<void> Cell::attach_at_workframe(std::string_view part, std::string_view predecessor,
                                       std::string_view workframe) {
  const auto f2 = state_->find(part);
  if (!f2) return std::unexpected(f2.error());
  const auto f1 = state_->find(predecessor);
  if (!f1) return std::unexpected(f1.error());
  const auto w = state_->find(workframe, PathKind::workframe);
  if (!w) return std::unexpected(w.error());
  if (auto checked = check_connection(*state_, *f2, *f1); !checked) return checked;
  Node& node = state_->at(*f2);
  node.X_PF = state_->at(*w).X_PF;
  node.predecessor = *f1;
  state_->changed_structure();
  return {};
}

Result<void> Cell::set_camera(std::string_view camera, double focal_distance_m, double fovy_rad) {
  const auto id = state_->find(camera, PathKind::camera);
  if (!id) return std::unexpected(id.error());
  if (focal_distance_m > kFarthest) {
    return fail(fmt::format("the viewing distance of {} is {:.10g} m, but at most {:.10g} m", camera, focal_distance_m,
                            kFarthest));
  }
  if (!(focal_distance_m > 0.0))
    return fail(fmt::format("the viewing distance of {} is {:g} m, but must be positive", camera, focal_distance_m));
  if (!std::isfinite(fovy_rad) || fovy_rad <= 0.0 || fovy_rad >= std::numbers::pi)
    return fail(fmt::format("the opening angle of {} is {:g} rad, but must be between 0 and pi", camera, fovy_rad));
  state_->at(*id).camera = {focal_distance_m, fovy_rad};
  state_->changed();
  return {};
}

Result<void> Cell::set_sensor_active(std::string_view sensor, bool active) {
  const auto id = state_->find(sensor, PathKind::sensor);
  if (!id) return std::unexpected(id.error());
  bool& present = state_->at(*id).sensor.active;
  if (present != active) state_->changed();
  present = active;
  return {};
}

Result<void> Cell::set_sensor_range(std::string_view sensor, double range_m) {
  const auto id = state_->find(sensor, PathKind::sensor);
  if (!id) return std::unexpected(id.error());
  const double range_mm = mm_from_m(range_m);
  if (range_m > kFarthest) {
    return fail(
        fmt::format("the range of {} is {:.10g} mm, but at most {:.10g} mm", sensor, range_mm, mm_from_m(kFarthest)));
  }
  if (!(range_m > 0.0)) return fail(fmt::format("the range of {} is {:g} mm, but must be positive", sensor, range_mm));
  if (const double blind_mm = mm_from_m(state_->at(*id).sensor.blind_zone_m); range_mm <= blind_mm) {
    return fail(
        fmt::format("the range of {} is {:.10g} mm, within its blind zone of {:.10g} mm", sensor, range_mm, blind_mm),
        fmt::format("give more than {:.10g} mm", blind_mm));
  }
  double& present = state_->at(*id).sensor.range_m;
  if (present != range_m) state_->changed();
  present = range_m;
  return {};
}

Pose Cell::world_pose(NodeId id, std::span<const JointValues> q) const {
  Pose X_WN = Pose::Identity();
  for (NodeId up = id; up != kRootNode; up = state_->at(up).predecessor) {
    const Node& node = state_->at(up);
    Pose X_PN = node.X_PF;
    if (node.kind() == NodeKind::joint) {
      const JointBinding& binding = node.binding;
      CELLMIRROR_EXPECTS(binding.slot < q.size());
      X_PN = X_PN * joint_motion(node.definition->joint->kind, node.definition->joint->axis,
                                 binding.multiplier * q[binding.slot][binding.joint] + binding.offset);
    }
    X_WN = X_PN * X_WN;
  }
  return X_WN;
}

}  // namespace cellmirror
