#include "rt_core/collision/pair_proof.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rt_core/collision/bounds.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::collision {

namespace {

// m; far above the rounding errors of poses, distances and bounds for any machine that fits in a hall.
constexpr double kProofSlack = 1e-6;
// Share of a depth that counts: the depth of convex bodies comes from an iteration that ends near the true value.
constexpr double kDepthShare = 0.99;

std::array<Eigen::Vector3d, 8> corners_of(const OrientedBox& box) {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d sign((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0, (i & 4U) != 0 ? 1.0 : -1.0);
    corners[i] = box.X_NB * Eigen::Vector3d(sign.cwiseProduct(box.half));
  }
  return corners;
}

double farthest(const std::array<Eigen::Vector3d, 8>& corners, const Pose& X) {
  double most = 0;
  for (const Eigen::Vector3d& corner : corners) most = std::max(most, (X * corner).norm());
  return most;
}

std::pair<MotionBound::JointBox, MotionBound::JointBox> halves(const MotionBound::JointBox& box, int variable) {
  const auto i = static_cast<std::size_t>(variable);
  std::pair<MotionBound::JointBox, MotionBound::JointBox> out{box, box};
  const double half = 0.5 * box.half[i];
  out.first.half[i] = out.second.half[i] = half;
  out.first.centre[i] -= half;
  out.second.centre[i] += half;
  return out;
}

// Halves the range level by level until `decide` has proved every box or refuted one. `decide` gets the motion within
// the box, and adds the number of its tests to `tests`.
template <class Decide>
ProofResult divide(MotionBound& bound, int most_tests, Decide decide) {
  ProofResult result;
  std::vector<MotionBound::JointBox> open{bound.whole_range()};
  std::vector<MotionBound::JointBox> next;
  while (!open.empty()) {
    next.clear();
    for (const MotionBound::JointBox& box : open) {
      const double motion = bound.compute(box);
      const Proof found = decide(motion, result.tests);
      if (found == Proof::refuted) {
        result.proof = found;
        return result;
      }
      if (found == Proof::proved) continue;
      const int widest = bound.widest();
      if (widest < 0) return result;
      auto [lower, upper] = halves(box, widest);
      next.push_back(std::move(lower));
      next.push_back(std::move(upper));
      // Each of these boxes needs at least one test.
      if (result.tests + static_cast<int>(next.size()) > most_tests) return result;
    }
    open.swap(next);
  }
  result.proof = Proof::proved;
  return result;
}

bool ranges_are_whole(const RelativeMotion& motion) {
  return std::ranges::all_of(motion.variables, &SampledRange::whole);
}

// Greatest depth of one part in another, m; negative without contact.
class BodyDepth {
 public:
  BodyDepth(const Body& a, const Body& b) : a_(a), b_(b) {}

  double at(const Pose& X_AB, int& tests) {
    double deepest = -1.0;
    ++tests;
    for (const BodyPart& a : a_.parts) {
      const PlacedBox box_a = placed(a, Pose::Identity());
      for (const BodyPart& b : b_.parts) {
        if (lower_bound(box_a, placed(b, X_AB), 0.0) > 0.0) continue;
        ++tests;
        if (geometry::contact(*a.solid, a.X_NG, *b.solid, X_AB * b.X_NG, 1, contact_))
          deepest = std::max(deepest, contact_.deepest.depth);
      }
    }
    return deepest;
  }

 private:
  static PlacedBox placed(const BodyPart& part, const Pose& X) {
    const OrientedBox box = box_around(part);
    PlacedBox out;
    out.half = box.half;
    out.radius = part.solid->radius;
    out.place(X, box);
    return out;
  }

  const Body& a_;
  const Body& b_;
  geometry::Contact contact_;
};

}  // namespace

MotionBound::MotionBound(const RelativeMotion& motion, const Body& a, const Body& b)
    : motion_(motion),
      corners_a_(corners_of(box_around(a))),
      corners_b_(corners_of(box_around(b))),
      by_variable_(motion.variables.size(), 0.0) {
  for (auto link = motion.to_a.links.rbegin(); link != motion.to_a.links.rend(); ++link)
    steps_.emplace_back().link = &*link;
  for (const JointChain::Link& link : motion.to_b.links) steps_.emplace_back().link = &link;
  // Lengths along the chain: no posture can stretch it further.
  const std::size_t of_a = motion.to_a.links.size();
  double length = farthest(corners_a_, motion.to_a.X_tail);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const double fixed = steps_[i].link->X_PJ.translation().norm();
    if (i < of_a) {
      steps_[i].most_to_a = length;
      length += extent(*steps_[i].link) + fixed;
    } else {
      length += fixed;
      steps_[i].most_to_a = length;
      length += extent(*steps_[i].link);
    }
  }
  length = farthest(corners_b_, motion.to_b.X_tail);
  for (std::size_t i = steps_.size(); i-- > 0;) {
    const double fixed = steps_[i].link->X_PJ.translation().norm();
    if (i >= of_a) {
      steps_[i].most_to_b = length;
      length += extent(*steps_[i].link) + fixed;
    } else {
      length += fixed;
      steps_[i].most_to_b = length;
      length += extent(*steps_[i].link);
    }
  }
}

// Greatest displacement by a linear joint, m; 0 for other joints.
double MotionBound::extent(const JointChain::Link& link) const {
  if (link.kind != JointKind::prismatic) return 0;
  const SampledRange& range = motion_.variables[link.variable];
  const double most = std::max(std::abs(range.lower), std::abs(range.upper));
  return link.axis.norm() * (std::abs(link.multiplier) * most + std::abs(link.offset));
}

MotionBound::JointBox MotionBound::whole_range() const {
  JointBox box;
  for (const SampledRange& range : motion_.variables) {
    box.centre.push_back(0.5 * (range.lower + range.upper));
    box.half.push_back(0.5 * (range.upper - range.lower));
  }
  return box;
}

Pose MotionBound::walk(const JointChain& chain, std::span<const double> values, std::size_t first, bool backwards) {
  Pose X = Pose::Identity();
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const JointChain::Link& link = chain.links[i];
    Step& step = steps_[backwards ? first - i : first + i];
    X = X * link.X_PJ;
    step.origin = X.translation();
    step.axis = X.linear() * link.axis;
    X = X * joint_motion(link.kind, link.axis, link.multiplier * values[link.variable] + link.offset);
  }
  return X * chain.X_tail;
}

// Displacement of a body by one joint, m. `others`: its displacement by the joints between this one and the body.
double MotionBound::moved(const Step& step, double half, const Corners& corners, double others, double most) {
  if (step.link->kind == JointKind::prismatic) return half * step.axis.norm();
  double reach = 0;
  for (const Eigen::Vector3d& corner : corners) reach = std::max(reach, (corner - step.origin).cross(step.axis).norm());
  return 2.0 * std::sin(0.5 * std::min(half, std::numbers::pi)) * std::min(reach + others, most);
}

double MotionBound::compute(const JointBox& box) {
  const std::size_t of_a = motion_.to_a.links.size();
  const Pose X_PA = walk(motion_.to_a, box.centre, of_a == 0 ? 0 : of_a - 1, true);
  const Pose X_PB = walk(motion_.to_b, box.centre, of_a, false);
  X_AB_ = X_PA.inverse() * X_PB;
  Corners corners_a;
  Corners corners_b;
  for (std::size_t i = 0; i < corners_a.size(); ++i) {
    corners_a[i] = X_PA * corners_a_[i];
    corners_b[i] = X_PB * corners_b_[i];
  }
  const auto half = [&box](const Step& step) {
    return std::abs(step.link->multiplier) * box.half[step.link->variable];
  };
  double others = 0;
  for (Step& step : steps_) {
    step.to_a = moved(step, half(step), corners_a, others, step.most_to_a);
    others += step.to_a;
  }
  others = 0;
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    step->to_b = moved(*step, half(*step), corners_b, others, step->most_to_b);
    others += step->to_b;
  }
  // A joint changes the distance by at most the displacement of either body in the frame of the other: the lesser
  // counts.
  std::ranges::fill(by_variable_, 0.0);
  double sum = 0;
  for (const Step& step : steps_) {
    const double least = std::min(step.to_a, step.to_b);
    by_variable_[step.link->variable] += least;
    sum += least;
  }
  return sum;
}

int MotionBound::widest() const {
  const auto most = std::ranges::max_element(by_variable_);
  return most == by_variable_.end() || !(*most > 0) ? -1 : static_cast<int>(most - by_variable_.begin());
}

ProofResult prove_apart(const RelativeMotion& motion, const Body& a, const Body& b, double margin) {
  if (!ranges_are_whole(motion)) return {};
  MotionBound bound(motion, a, b);
  BodyProximity proximity(a, b);
  return divide(bound, kMostApartTests, [&](double moved, int& tests) {
    ++tests;
    const double needed = moved + margin + kProofSlack;
    const double distance = proximity.distance(bound.X_AB(), needed + kProofSlack);
    if (distance > needed) return Proof::proved;
    return distance <= margin ? Proof::refuted : Proof::undecided;
  });
}

ProofResult prove_touching(const RelativeMotion& motion, const Body& a, const Body& b) {
  if (!ranges_are_whole(motion)) return {};
  MotionBound bound(motion, a, b);
  BodyDepth depth(a, b);
  const auto is_mesh = [](const BodyPart& part) { return part.solid->tree != nullptr; };
  const bool meshes = std::ranges::any_of(a.parts, is_mesh) || std::ranges::any_of(b.parts, is_mesh);
  return divide(bound, meshes ? kMostTouchTests : kMostConvexTouchTests, [&](double moved, int& tests) {
    const double deepest = depth.at(bound.X_AB(), tests);
    if (deepest < 0) return Proof::refuted;
    return kDepthShare * deepest - kProofSlack > moved ? Proof::proved : Proof::undecided;
  });
}

}  // namespace cellmirror::collision
