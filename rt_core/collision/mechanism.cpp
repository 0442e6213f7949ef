#include "rt_core/collision/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellmirror::collision {

namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const Pose& X) {
  bytes.append(reinterpret_cast<const char*>(X.data()), 16 * sizeof(double));
}

void append(std::string& bytes, const JointChain& chain) {
  append(bytes, chain.links.size());
  for (const JointChain::Link& link : chain.links) {
    append(bytes, link.X_PJ);
    for (int i = 0; i < 3; ++i) append(bytes, link.axis[i]);
    append(bytes, link.multiplier);
    append(bytes, link.offset);
    append(bytes, link.kind);
    append(bytes, link.variable);
  }
  append(bytes, chain.X_tail);
}

// Restricts joints that turn farther than once to one turn. Their postures repeat after a turn only if every link that
// follows the joint turns by an integer multiple of it.
void restrict_to_a_turn(RelativeMotion& motion) {
  constexpr double kPi = std::numbers::pi;
  for (std::size_t i = 0; i < motion.variables.size(); ++i) {
    SampledRange& range = motion.variables[i];
    const bool endless = range.lower == -kPi && range.upper == kPi;
    if (!endless && range.upper - range.lower <= 2.0 * kPi) continue;
    bool repeats = true;
    for (const JointChain* chain : {&motion.to_a, &motion.to_b}) {
      for (const JointChain::Link& link : chain->links) {
        if (link.variable != i) continue;
        repeats = repeats && link.kind != JointKind::prismatic && link.multiplier == std::round(link.multiplier);
      }
    }
    if (repeats) {
      range.lower = -kPi;
      range.upper = kPi;
    } else if (endless) {
      range.whole = false;
    }
  }
}

}  // namespace

SampledRange sampled_range(const CompiledRobot& robot, std::size_t joint) {
  constexpr SampledRange kTurn{-std::numbers::pi, std::numbers::pi, true};
  constexpr SampledRange kSomewhere{-10.0, 10.0, false};  // m: a linear joint without limits
  const bool linear = robot.joint_kinds[joint] == JointKind::prismatic;
  if (robot.joint_kinds[joint] == JointKind::continuous) return kTurn;
  const double lower = robot.min_range[joint];
  const double upper = robot.max_range[joint];
  if (!(upper >= lower) || !std::isfinite(lower) || !std::isfinite(upper)) return linear ? kSomewhere : kTurn;
  const double tolerance = linear ? kLinearRangeTolerance : kRangeTolerance;
  return {lower - tolerance, upper + tolerance, true};
}

bool RangeWatch::note(const CompiledCell& cell, std::span<const JointValues> q) {
  bool news = false;
  for (const CompiledRobot& robot : cell.robots) {
    if (beyond_.test(robot.slot) || robot.slot >= q.size()) continue;
    for (std::size_t joint = 0; joint < robot.joint_kinds.size(); ++joint) {
      if (robot.joint_kinds[joint] == JointKind::continuous) continue;
      const double tolerance =
          robot.joint_kinds[joint] == JointKind::prismatic ? kLinearRangeTolerance : kRangeTolerance;
      const double position = q[robot.slot][joint];
      if (position >= robot.min_range[joint] - tolerance && position <= robot.max_range[joint] + tolerance) continue;
      beyond_.set(robot.slot);
      news = true;
      break;
    }
  }
  return news;
}

Pose JointChain::end(std::span<const double> values) const {
  Pose X = Pose::Identity();
  for (const Link& link : links) {
    X = X * link.X_PJ * joint_motion(link.kind, link.axis, link.multiplier * values[link.variable] + link.offset);
  }
  return X * X_tail;
}

Pose RelativeMotion::X_AB(std::span<const double> values) const {
  return to_a.end(values).inverse() * to_b.end(values);
}

void RelativeMotion::append_signature(std::string& bytes) const {
  append(bytes, to_a);
  append(bytes, to_b);
  for (const SampledRange& range : variables) {
    append(bytes, range.lower);
    append(bytes, range.upper);
    append(bytes, range.whole);
  }
}

Mechanism::Mechanism(const CompiledCell& cell, const SlotSet& beyond)
    : cell_(cell), beyond_(beyond), group_(cell.size(), 0), link_of_(cell.size(), -1) {
  std::vector<std::int32_t> component_robot(cell.size(), -1);
  for (std::size_t i = 0; i < cell.robots.size(); ++i)
    component_robot[at(cell.robots[i].component)] = static_cast<std::int32_t>(i);
  // The innermost robot in whose component the node is named.
  const auto named_in = [&](std::int32_t node) {
    for (std::int32_t up = node; up >= 0; up = cell.naming_parent[at(up)]) {
      if (component_robot[at(up)] >= 0) return component_robot[at(up)];
    }
    return -1;
  };
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const std::int32_t parent = cell.parent[i];
    if (cell.joint_of[i] >= 0)
      group_[i] = static_cast<std::int32_t>(i);
    else if (parent >= 0)
      group_[i] = group_[at(parent)];
    const std::int32_t robot = named_in(static_cast<std::int32_t>(i));
    if (component_robot[i] >= 0 || (robot >= 0 && parent >= 0 && link_of_[at(parent)] == robot)) link_of_[i] = robot;
  }
}

std::int32_t Mechanism::group_above(std::int32_t group) const {
  const std::int32_t parent = cell_.parent[at(group)];
  return parent < 0 ? -1 : group_[at(parent)];
}

std::int32_t Mechanism::single_joint(std::int32_t a, std::int32_t b) const {
  const std::int32_t above = std::min(group(a), group(b));
  const std::int32_t below = std::max(group(a), group(b));
  return above != below && group_above(below) == above ? below : -1;
}

JointChain Mechanism::chain(std::int32_t above, std::int32_t below, RelativeMotion& motion,
                            std::vector<std::uint32_t>& keys) const {
  std::vector<std::int32_t> nodes;
  for (std::int32_t node = below; node != above; node = cell_.parent[at(node)]) nodes.push_back(node);
  JointChain chain;
  Pose X = Pose::Identity();
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    X = X * cell_.X_PF[at(*node)];
    if (cell_.joint_of[at(*node)] < 0) continue;
    const CompiledJoint& joint = cell_.joints[at(cell_.joint_of[at(*node)])];
    const auto key = static_cast<std::uint32_t>(joint.slot) << 8U | joint.joint;
    auto known = std::ranges::find(keys, key);
    if (known == keys.end()) {
      const CompiledRobot* robot = cell_.robot(joint.slot);
      SampledRange range = robot != nullptr ? sampled_range(*robot, joint.joint) : SampledRange{};
      range.whole = range.whole && robot != nullptr && !beyond_.test(joint.slot);
      motion.variables.push_back(range);
      known = keys.insert(keys.end(), key);
    }
    chain.links.push_back(
        {X, joint.axis, joint.multiplier, joint.offset, joint.kind, static_cast<std::uint32_t>(known - keys.begin())});
    X = Pose::Identity();
  }
  chain.X_tail = X;
  return chain;
}

RelativeMotion Mechanism::between(std::int32_t a, std::int32_t b) const {
  std::int32_t above_a = a;
  std::int32_t above_b = b;
  while (above_a != above_b) {
    // Parents come before their children.
    std::int32_t& lower = above_a > above_b ? above_a : above_b;
    lower = cell_.parent[at(lower)];
  }
  RelativeMotion motion;
  std::vector<std::uint32_t> keys;
  motion.to_a = chain(above_a, a, motion, keys);
  motion.to_b = chain(above_a, b, motion, keys);
  restrict_to_a_turn(motion);
  return motion;
}

}  // namespace cellmirror::collision
