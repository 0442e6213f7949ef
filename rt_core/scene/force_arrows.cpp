#include "rt_core/scene/force_arrows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kShortestPart = 0.2;

// The smallest of 1, 2, 5 times a power of ten that is not below `value`.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

double largest_of(std::span<const ForceArrow> arrows, bool torque) {
  double largest = 0.0;
  for (const ForceArrow& arrow : arrows) {
    const double length = arrow.vector.norm();
    if (arrow.torque == torque && std::isfinite(length)) largest = std::max(largest, length);
  }
  return largest;
}

}  // namespace

double ArrowScale::update(double largest, double longest_m) {
  if (!(largest > 0.0) || !(longest_m > 0.0)) return per_metre_;
  const double needed = largest / longest_m;
  if (needed > per_metre_ || needed < kShortestPart * per_metre_) per_metre_ = round_up(needed);
  return per_metre_;
}

void label_overloads(const ForceState& forces, Scene& scene) {
  for (const RobotForces& robot : forces.robots) {
    for (const JointForce& joint : robot.joints) {
      if (!joint.beyond_limit || !joint.X_WJ.translation().allFinite()) continue;
      const std::string_view unit = joint.kind == JointKind::prismatic ? "N" : "Nm";
      const double effort = std::round(joint.effort * 10.0) / 10.0;
      scene.labels.push_back({joint.X_WJ.translation(),
                              fmt::format("{} {}: {}, beyond its {}", robot.id, joint.name, quantity_text(effort, unit),
                                          quantity_text(joint.max_effort, unit)),
                              Mark::near});
    }
  }
}

void ForceArrows::draw(std::span<const ForceArrow> arrows, double longest_m, Scene& scene) {
  const double largest_force = largest_of(arrows, false);
  const double largest_torque = largest_of(arrows, true);
  force_.update(largest_force, longest_m);
  torque_.update(largest_torque, longest_m);
  shown_force_ = largest_force > 0.0 ? force_.per_metre() : 0.0;
  shown_torque_ = largest_torque > 0.0 ? torque_.per_metre() : 0.0;
  for (const ForceArrow& arrow : arrows) {
    const double per_metre = arrow.torque ? shown_torque_ : shown_force_;
    if (!(per_metre > 0.0) || !arrow.vector.allFinite()) continue;
    scene.arrows.push_back(
        {arrow.from_m, arrow.vector / per_metre, arrow.torque ? palette::kTorque : palette::kForce, arrow.torque});
  }
}

}  // namespace cellmirror::scene
