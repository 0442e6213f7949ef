#include "rt_core/collision/contact_rates.hpp"

#include <algorithm>
#include <array>

namespace cellmirror::collision {

namespace {

using Eigen::Vector3d;

// Adds `sign` times the velocity along `direction` that the robot's joints give a point on the body at `node`.
void add_rates(const CompiledCell& cell, const CellPoses& poses, std::int32_t node, std::size_t slot,
               const Vector3d& point, const Vector3d& direction, double sign, DepthRates& rates) {
  for (; node > 0; node = cell.parent[static_cast<std::size_t>(node)]) {
    const std::int32_t number = cell.joint_of[static_cast<std::size_t>(node)];
    if (number < 0) continue;
    const CompiledJoint& joint = cell.joints[static_cast<std::size_t>(number)];
    if (joint.slot != slot) continue;
    // The joint's own motion moves neither its axis nor, where it turns, the origin on it.
    const Pose& X_WJ = poses.X_WN[static_cast<std::size_t>(node)];
    const Vector3d axis = X_WJ.linear() * joint.axis;
    const bool slides = joint.kind == JointKind::prismatic;
    const Vector3d velocity = slides ? axis : axis.cross(point - X_WJ.translation());
    rates[joint.joint] += sign * joint.multiplier * velocity.dot(direction);
  }
}

}  // namespace

DepthRates depth_rates(const CompiledCell& cell, const CellPoses& poses, std::int32_t a, std::int32_t b,
                       const TouchingPair& contact, std::size_t slot) {
  DepthRates rates{};
  add_rates(cell, poses, a, slot, contact.point_m, contact.normal, 1.0, rates);
  add_rates(cell, poses, b, slot, contact.point_m, contact.normal, -1.0, rates);
  return rates;
}

RobotContacts robot_contacts(const CompiledCell& cell, const CellPoses& poses, const PairTable& table,
                             const ProximityState& found, std::size_t slot) {
  constexpr double kLeast = 1e-9;  // m/rad or m/m: rounding of joints that cancel
  RobotContacts out;
  out.posture_time = found.posture_time;
  std::array<double, RobotContacts::kMost> depths{};
  for (const TouchingPair& pair : found.touching) {
    if (pair.normal.isZero() || !pair.normal.allFinite() || !pair.point_m.allFinite()) continue;
    const DepthRates rates = depth_rates(cell, poses, table.bodies[pair.a].node, table.bodies[pair.b].node, pair, slot);
    if (std::ranges::all_of(rates, [](double rate) { return !(std::abs(rate) > kLeast); })) continue;
    const auto place = out.count < RobotContacts::kMost
                           ? static_cast<std::ptrdiff_t>(out.count++)
                           : std::distance(depths.begin(), std::ranges::min_element(depths));
    const auto index = static_cast<std::size_t>(place);
    if (out.count == RobotContacts::kMost && depths[index] > pair.depth_m) continue;
    depths[index] = pair.depth_m;
    out.rates[index] = rates;
  }
  return out;
}

}  // namespace cellmirror::collision
