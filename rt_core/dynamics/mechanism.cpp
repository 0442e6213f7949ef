#include "rt_core/dynamics/mechanism.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <utility>

namespace cellmirror::dynamics {

namespace {

bool all_finite(std::initializer_list<double> values) {
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

Result<void> check_drive(const Drive& drive) {
  if (!all_finite(
          {drive.gear_ratio, drive.rotor_inertia, drive.coulomb_friction, drive.viscous_friction, drive.max_effort})) {
    return fail("a number is not finite");
  }
  if (drive.rotor_inertia < 0.0 || drive.coulomb_friction < 0.0 || drive.viscous_friction < 0.0 ||
      drive.max_effort < 0.0) {
    return fail("the rotor's inertia, friction or the greatest effort is negative");
  }
  return {};
}

Result<void> check_link(const Link& link, std::size_t before, std::size_t variables) {
  if (link.parent < -1 || link.parent >= static_cast<int>(before)) return fail("its parent must come before it");
  if (link.variable >= variables) return fail(fmt::format("there is no variable {}", link.variable));
  if (!kinematics::is_pose(link.X_PJ)) return fail("its frame is not a pose");
  if (!all_finite({link.multiplier, link.offset})) return fail("its multiplier or offset is not finite");
  constexpr double kUnit = 1e-6;
  if (!link.axis.allFinite() || std::abs(link.axis.norm() - 1.0) > kUnit) return fail("its axis is not a unit vector");
  return check(link.inertia);
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

LinkMotion motion_of(const Link& link) {
  const Eigen::Matrix3d R = link.X_PJ.linear();
  LinkMotion motion;
  motion.p = link.X_PJ.translation();
  if (link.kind == JointKind::prismatic) {
    motion.fixed = R;
    motion.sine.setZero();
    motion.cosine.setZero();
    motion.slide = R * link.axis;
    return motion;
  }
  const Eigen::Matrix3d along = link.axis * link.axis.transpose();
  motion.fixed = R * along;
  motion.sine = R * cross_matrix(link.axis);
  motion.cosine = R - motion.fixed;
  motion.slide.setZero();
  return motion;
}

}  // namespace

Result<Mechanism> Mechanism::make(std::span<const Drive> drives, std::span<const Link> links, int tip_link,
                                  const Pose& X_LT) {
  if (drives.size() > kMaxJointsPerRobot) {
    return fail(fmt::format("{} joints: at most {} can be computed together", drives.size(), kMaxJointsPerRobot));
  }
  if (links.size() > kMaxLinks) {
    return fail(
        fmt::format("{} joints, mimics included: at most {} can be computed together", links.size(), kMaxLinks));
  }
  if (tip_link < -1 || tip_link >= static_cast<int>(links.size())) return fail("there is no such tip link");
  if (!kinematics::is_pose(X_LT)) return fail("the tip is not a pose");
  Mechanism mechanism;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (const auto checked = check_drive(drives[i]); !checked) {
      return fail(fmt::format("the drive of joint {}: {}", i + 1, checked.error().what));
    }
    mechanism.drives_[i] = drives[i];
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (const auto checked = check_link(links[i], i, drives.size()); !checked) {
      return fail(fmt::format("link {}: {}", i + 1, checked.error().what), checked.error().remedy);
    }
    mechanism.links_[i] = links[i];
    mechanism.motions_[i] = motion_of(links[i]);
  }
  mechanism.variable_count_ = drives.size();
  mechanism.link_count_ = links.size();
  mechanism.tip_link_ = tip_link;
  mechanism.X_LT_ = X_LT;
  return mechanism;
}

double Mechanism::moving_mass() const CELL_RT {
  double mass = 0;
  for (const Link& link : links()) mass += link.inertia.mass;
  return mass;
}

Result<Mechanism> Mechanism::with_payload(const Inertia& inertia) const {
  if (auto checked = check(inertia); !checked) return std::unexpected(std::move(checked.error()));
  Mechanism loaded = *this;
  if (tip_link_ < 0) return loaded;
  Inertia& at = loaded.links_[static_cast<std::size_t>(tip_link_)].inertia;
  at = joined(at, moved(inertia, X_LT_));
  return loaded;
}

}  // namespace cellmirror::dynamics
