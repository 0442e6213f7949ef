#include "sim_devices/haptic/axes.hpp"

#include <algorithm>

#include "rt_core/base/contract.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::array<std::string_view, 5> kTrocarNames{"yaw", "pitch", "insertion", "roll", "jaw"};
constexpr std::array<std::string_view, 7> kSpaceNames{"x", "y", "z", "rx", "ry", "rz", "gripper"};

Eigen::Quaterniond rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

}  // namespace

AxisLayout::AxisLayout(std::size_t axes) : count_(axes) { CELLMIRROR_EXPECTS(axes >= 4 && axes <= kMaxHapticAxes); }

std::span<const std::string_view> AxisLayout::names() const {
  return is_trocar() ? std::span<const std::string_view>(kTrocarNames).first(count_)
                     : std::span<const std::string_view>(kSpaceNames).first(count_);
}

AxisKind AxisLayout::kind(std::size_t axis) const {
  if (is_trocar()) return axis == 4 ? AxisKind::gripper : axis == 2 ? AxisKind::length : AxisKind::angle;
  return axis == 6 ? AxisKind::gripper : axis < 3 ? AxisKind::length : AxisKind::angle;
}

std::optional<std::size_t> AxisLayout::find(std::string_view name) const {
  const auto known = names();
  const auto at = std::find(known.begin(), known.end(), name);
  if (at == known.end()) return std::nullopt;
  return static_cast<std::size_t>(at - known.begin());
}

void AxisLayout::show(const Coordinates& coordinates, HapticSample& sample) const {
  const Coordinates& q = coordinates;
  sample.axis_count = static_cast<std::uint8_t>(count_);
  sample.axes = q;
  if (is_trocar()) {
    const Eigen::Quaterniond shaft = Eigen::Quaterniond(Eigen::AngleAxisd(q[0], Eigen::Vector3d::UnitZ()) *
                                                        Eigen::AngleAxisd(q[1], Eigen::Vector3d::UnitY()));
    sample.p_DH = shaft * Eigen::Vector3d(0, 0, q[2]);
    sample.q_DH = shaft * Eigen::Quaterniond(Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitZ()));
    sample.gripper = count_ > 4 ? q[4] : 0;
    return;
  }
  sample.p_DH = {q[0], q[1], q[2]};
  sample.q_DH = rotation({q[3], q[4], q[5]});
  sample.gripper = count_ > 6 ? q[6] : 0;
}

Coordinates AxisLayout::efforts(const HapticOutput& output) const {
  Coordinates pushed{};
  if (is_trocar()) {
    const std::size_t known = std::min<std::size_t>(count_, output.joint_count);
    std::copy_n(output.joint_torques.begin(), known, pushed.begin());
    return pushed;
  }
  for (int i = 0; i < 3; ++i) {
    pushed[static_cast<std::size_t>(i)] = output.force_D[i];
    pushed[static_cast<std::size_t>(i) + 3] = output.torque_D[i];
  }
  if (count_ > 6) pushed[6] = output.gripper_torque;
  return pushed;
}

}  // namespace cellmirror::sim
