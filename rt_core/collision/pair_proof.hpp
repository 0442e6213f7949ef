// Proves for every posture within the joint ranges that two bodies stay apart, or that they always touch: the ranges
// are divided into boxes until the distance (or the depth) at the centre of each box exceeds the largest change that
// the motion within the box can cause.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "rt_core/collision/body_proximity.hpp"
#include "rt_core/collision/mechanism.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// Most tests for one proof. Beyond this number the pair stays undecided, and is tested at run time.
inline constexpr int kMostApartTests = 6'000;
inline constexpr int kMostTouchTests = 2'000;  // with meshes, whose contacts take longer
inline constexpr int kMostConvexTouchTests = 50'000;

enum class Proof : std::uint8_t { proved, refuted, undecided };

struct ProofResult {
  Proof proof = Proof::undecided;
  int tests = 0;  // postures or contacts that were computed
};

// Upper bound of the relative displacement of two bodies within a box of joint positions. `motion` outlives it.
class MotionBound {
 public:
  MotionBound(const RelativeMotion& motion, const Body& a, const Body& b);

  // Positions of the variables of the motion: centre plus or minus half.
  struct JointBox {
    std::vector<double> centre;
    std::vector<double> half;
  };
  [[nodiscard]] JointBox whole_range() const;

  // Returns the bound in m: no point of one body moves farther in the frame of the other between the centre of the box
  // and any posture within it. It is the sum over the joints, moved one after the other.
  double compute(const JointBox& box);
  // Pose of B in A at the centre of the box of the last compute().
  [[nodiscard]] const Pose& X_AB() const { return X_AB_; }
  // The variable that contributed most to the last compute(); -1: none contributed.
  [[nodiscard]] int widest() const;

 private:
  using Corners = std::array<Eigen::Vector3d, 8>;
  // A joint on the way from a to b.
  struct Step {
    const JointChain::Link* link = nullptr;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // on its axis, at the centre of the box
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double most_to_a = 0;  // m, from its axis to any point of the body, in any posture
    double most_to_b = 0;
    double to_a = 0;  // m, displacement of a by this joint within the box
    double to_b = 0;
  };

  [[nodiscard]] double extent(const JointChain::Link& link) const;
  Pose walk(const JointChain& chain, std::span<const double> values, std::size_t first, bool backwards);
  static double moved(const Step& step, double half, const Corners& corners, double others, double most);

  const RelativeMotion& motion_;
  Corners corners_a_;  // of a box around the body, in its node
  Corners corners_b_;
  std::vector<Step> steps_;  // of to_a from its end, then of to_b from its beginning
  std::vector<double> by_variable_;
  Pose X_AB_ = Pose::Identity();
};

// Proves that the bodies stay more than `margin` (m) apart in every posture. Refuted: a posture contradicts it.
[[nodiscard]] ProofResult prove_apart(const RelativeMotion& motion, const Body& a, const Body& b, double margin);
// Proves that the bodies touch in every posture. Refuted: a posture contradicts it.
[[nodiscard]] ProofResult prove_touching(const RelativeMotion& motion, const Body& a, const Body& b);

}  // namespace cellmirror::collision
