// All postures of arms with six revolute joints in closed form, for arms whose axes have one of the known special
// arrangements. Found from the axes themselves: any frames, any position zero, no convention of parameters.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "rt_core/base/pose.hpp"
#include "rt_core/inverse_kinematics/closed_form_parallel.hpp"
#include "rt_core/inverse_kinematics/closed_form_wrist.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::inverse_kinematics {

inline constexpr std::size_t kMaxClosedForms = closed_form::kMaxPostures;

// Immutable once made; any number of threads.
class ClosedForm {
 public:
  // Nothing where the chain does not have exactly six revolute joints, each moved by its own variable, or where its
  // axes are of no known arrangement. A chain that is nearly of one (a calibrated arm: some mm, some mrad) is taken
  // with exact() false. Every candidate has to find sampled postures again before it is returned. For worker threads:
  // some 0.1 ms.
  static std::optional<ClosedForm> analyse(const kinematics::Chain& chain);

  // The same for seven revolute joints where holding the first or the last leaves an arm of a known arrangement: arms
  // with a spherical shoulder, whether their wrist is spherical (S-R-S) or has an offset.
  static std::optional<ClosedForm> analyse_redundant(const kinematics::Chain& chain);

  // All postures that bring the tip to X_BG (base to tip), angles in (-pi, pi], in no particular order; limits are not
  // applied. Returns their number, 0 where X_BG is out of reach. No heap.
  //
  // Where exact(), forward(q) meets X_BG to rounding, except for targets within 20 um beyond reach: these give the
  // posture of the nearest reach (stretched elbow), so that the caller's polishing decides. Where not exact(), the
  // postures are off by about what the axes are off, reach has as much slack, and polishing is needed.
  //
  // `near` (rad) gives the joints that the target leaves free: at a singular target one joint of those whose axes
  // coincide keeps its value (straight wrist: the fourth; target on axis 1: the first; three parallel axes with a
  // straight fifth joint: the sixth, or the nearest step of 15 degrees that reaches), the others follow; after
  // analyse_redundant() it gives free_joint() always. Postures that coincide at a border are returned once or twice.
  std::size_t solve(const Pose& X_BG, std::span<JointValues, kMaxClosedForms> out,
                    const JointValues& near = JointValues{}) const noexcept;

  // What was recognised, e.g. "spherical wrist, axes 2 and 3 parallel"; static text.
  [[nodiscard]] std::string_view family() const { return family_; }
  // The arrangement is that of the arm taken from its tip to its base: axis 1 of family() is the last joint.
  [[nodiscard]] bool from_tip() const { return from_tip_; }
  [[nodiscard]] bool exact() const { return exact_; }
  // By how much the axes miss the arrangement (m; angles times reach).
  [[nodiscard]] double deviation() const { return deviation_; }
  // Index of the joint that solve() takes from `near`; nothing for six joints.
  [[nodiscard]] std::optional<std::size_t> free_joint() const { return free_joint_; }

 private:
  using Arm = std::variant<closed_form::SphericalWrist, closed_form::ThreeParallel>;
  ClosedForm() = default;
  static std::optional<ClosedForm> analyse_arm(const kinematics::Chain& chain, std::optional<std::size_t> held);
  [[nodiscard]] bool finds_samples(const kinematics::Chain& chain) const;

  Arm arm_;
  bool from_tip_ = false;
  Pose X_TB0_ = Pose::Identity();  // base in the tip with all joints at zero
  std::optional<std::size_t> free_joint_;
  closed_form::Line free_axis_;  // at zero, in the base
  std::string_view family_;
  bool exact_ = false;
  double deviation_ = 0;
};

}  // namespace cellmirror::inverse_kinematics
