#include "rt_core/inverse_kinematics/seed_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "rt_core/inverse_kinematics/posture.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/kinematics/reach.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kLeavesPerSeed = 1;  // visited in one look-up; more hardly improve the seeds

// `value` moved by whole turns into the limits, nearest to `present`; the nearest limit where none lies within. A sum
// of turns is rounded, so that it may be beyond a limit by the last bits.
double turned_into(double lower, double upper, double value, double present) {
  value += kFullTurn * std::round((present - value) / kFullTurn);
  if (value > upper) value -= kFullTurn * std::ceil((value - upper) / kFullTurn);
  if (value >= lower) return std::min(value, upper);
  const double above = value + kFullTurn * std::ceil((lower - value) / kFullTurn);
  if (above <= upper) return std::max(above, lower);
  return lower - value < above - kFullTurn - upper ? lower
                                                   : (above - upper < lower - (above - kFullTurn) ? upper : lower);
}

}  // namespace

struct SeedTable::Nearest {
  std::array<Near, kMostSeeds> found{};
  std::size_t count = 0;
  std::size_t wanted = 0;
  std::size_t leaves = 0;

  [[nodiscard]] float worst() const {
    return count < wanted ? std::numeric_limits<float>::infinity() : found[count - 1].distance_sq;
  }
  void add(const Near& near) {
    if (!(near.distance_sq < worst())) return;
    std::size_t at = count < wanted ? count++ : count - 1;
    while (at > 0 && found[at - 1].distance_sq > near.distance_sq) {
      found[at] = found[at - 1];
      --at;
    }
    found[at] = near;
  }
};

SeedTable::SeedTable(const kinematics::Chain& chain, std::size_t entries) : chain_(chain), n_(chain.variable_count()) {
  const auto joints = chain_.joints();
  const kinematics::ChainJoint& first = joints.front();
  const kinematics::ChainJoint& last = joints.back();
  const bool reducible = chain_.plain() && joints.size() > 2;
  first_turns_ = reducible && first.kind != JointKind::prismatic;
  first_slides_ = reducible && first.kind == JointKind::prismatic;
  last_turns_ = reducible && last.kind != JointKind::prismatic;
  length_ = kinematics::unit_of_length(chain_);
  X_FB_ = first.X_PJ.inverse();
  X_TL_ = chain_.X_LT().inverse();
  sample(entries);
}

SeedTable::Placed SeedTable::place(const Pose& X_BT) const {
  const Pose X_FL = X_FB_ * X_BT * X_TL_;
  Placed placed;
  placed.R = X_FL.linear();
  Eigen::Vector3d p = X_FL.translation() / length_;
  Eigen::Vector3d a = X_FL.linear().col(2);
  if (first_turns_) {
    const double r = std::hypot(p.x(), p.y());
    // On the axis itself the direction has to say where the arm is turned to.
    constexpr double kOnAxis = 1e-9;
    const double c = r > kOnAxis ? p.x() / r : 1.0;
    const double s = r > kOnAxis ? p.y() / r : 0.0;
    placed.azimuth = std::atan2(s, c);
    a = Eigen::Vector3d(c * a.x() + s * a.y(), c * a.y() - s * a.x(), a.z());
    p = Eigen::Vector3d(r, 0.0, p.z());
  } else if (first_slides_) {
    placed.slide = X_FL.translation().z();
    p.z() = 0.0;
  }
  constexpr double kDirection = 0.5;  // weight of a direction (about rad) against a length; measured
  for (Eigen::Index k = 0; k < 3; ++k) {
    placed.feature[static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
    placed.feature[static_cast<std::size_t>(k) + 3] = static_cast<float>(kDirection * a[k]);
  }
  return placed;
}

void SeedTable::sample(std::size_t wanted) {
  const std::size_t leaves = std::bit_floor(std::max<std::size_t>(wanted / kLeaf, 1));
  const std::size_t count = leaves * kLeaf;
  entries_.resize(count);
  leaves_.resize(leaves);
  nodes_.resize(leaves - 1);
  std::vector<Feature> features(count);
  std::vector<std::uint32_t> indices(count);
  const PostureSpread spread(chain_);
  for (std::size_t k = 0; k < count; ++k) {
    JointValues q = spread.at(k);
    if (first_turns_ || first_slides_) q[0] = 0;
    if (last_turns_) q[n_ - 1] = 0;
    const Placed placed = place(kinematics::forward(chain_, {q.data(), n_}));
    Entry& entry = entries_[k];
    for (std::size_t i = 0; i < n_; ++i) entry.q[i] = static_cast<float>(q[i]);
    if (first_slides_) entry.q[0] = static_cast<float>(-placed.slide);
    entry.azimuth = static_cast<float>(placed.azimuth);
    for (Eigen::Index i = 0; i < 3; ++i) entry.x[static_cast<std::size_t>(i)] = static_cast<float>(placed.R(i, 0));
    features[k] = placed.feature;
    indices[k] = static_cast<std::uint32_t>(k);
  }
  build(0, indices, features);
}

void SeedTable::build(std::size_t node, std::span<std::uint32_t> indices, const std::vector<Feature>& features) {
  if (node >= nodes_.size()) {
    Leaf& leaf = leaves_[node - nodes_.size()];
    for (std::size_t i = 0; i < kLeaf; ++i) {
      leaf.entry[i] = indices[i];
      for (std::size_t k = 0; k < kFeatures; ++k) leaf.feature[k][i] = features[indices[i]][k];
    }
    return;
  }
  Feature least;
  Feature most;
  least.fill(std::numeric_limits<float>::infinity());
  most.fill(-std::numeric_limits<float>::infinity());
  for (const std::uint32_t index : indices) {
    for (std::size_t k = 0; k < kFeatures; ++k) {
      least[k] = std::min(least[k], features[index][k]);
      most[k] = std::max(most[k], features[index][k]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < kFeatures; ++k) {
    if (most[k] - least[k] > most[widest] - least[widest]) widest = k;
  }
  const std::size_t half = indices.size() / 2;
  std::nth_element(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(half), indices.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return features[a][widest] < features[b][widest]; });
  nodes_[node] = {features[indices[half]][widest], static_cast<std::uint8_t>(widest)};
  build(2 * node + 1, indices.first(half), features);
  build(2 * node + 2, indices.subspan(half), features);
}

// `offsets`: how far `wanted` lies outside of the node's box in each dimension; `bound`: the sum of their squares.
void SeedTable::visit(std::size_t node, const Feature& wanted, Feature& offsets, float bound, Nearest& nearest) const {
  if (nearest.leaves == 0 || !(bound < nearest.worst())) return;
  if (node >= nodes_.size()) {
    --nearest.leaves;
    const Leaf& leaf = leaves_[node - nodes_.size()];
    std::array<float, kLeaf> distance_sq{};
    for (std::size_t k = 0; k < kFeatures; ++k) {
      for (std::size_t i = 0; i < kLeaf; ++i) {
        const float d = leaf.feature[k][i] - wanted[k];
        distance_sq[i] += d * d;
      }
    }
    for (std::size_t i = 0; i < kLeaf; ++i) nearest.add({distance_sq[i], leaf.entry[i]});
    return;
  }
  const Node& split = nodes_[node];
  const float beyond = wanted[split.dimension] - split.split;
  const std::size_t near_child = beyond < 0 ? 2 * node + 1 : 2 * node + 2;
  const std::size_t far_child = beyond < 0 ? 2 * node + 2 : 2 * node + 1;
  visit(near_child, wanted, offsets, bound, nearest);
  const float before = offsets[split.dimension];
  offsets[split.dimension] = beyond;
  visit(far_child, wanted, offsets, bound - before * before + beyond * beyond, nearest);
  offsets[split.dimension] = before;
}

// Where the limits keep the first or last joint from going where the target wants, the pose is about that far off.
double SeedTable::miss_of(std::size_t variable, double wanted, double got) const {
  const double off = wanted - got;
  if (off == 0) return 0;
  const double miss = chain_.rotates(variable) ? 0.5 * (off - kFullTurn * std::round(off / kFullTurn)) : off / length_;
  return miss * miss;
}

Seed SeedTable::seed_of(const Near& near, const Placed& target, const JointValues& present) const {
  const Entry& entry = entries_[near.entry];
  Seed seed;
  for (std::size_t i = 0; i < n_; ++i) seed.q[i] = static_cast<double>(entry.q[i]);
  Eigen::Vector3d x(entry.x[0], entry.x[1], entry.x[2]);
  if (first_turns_) {
    const double turn = target.azimuth - static_cast<double>(entry.azimuth);
    seed.q[0] = turn;
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    x = Eigen::Vector3d(c * x.x() - s * x.y(), s * x.x() + c * x.y(), x.z());
  } else if (first_slides_) {
    seed.q[0] += target.slide;
  }
  if (last_turns_) seed.q[n_ - 1] = std::atan2(-x.dot(target.R.col(1)), x.dot(target.R.col(0)));
  seed.pose_distance_sq = static_cast<double>(near.distance_sq);
  for (std::size_t i = 0; i < n_; ++i) {
    const double lower = chain_.lower()[i];
    const double upper = chain_.upper()[i];
    const double wanted = seed.q[i];
    seed.q[i] = chain_.rotates(i) && chain_.plain() ? turned_into(lower, upper, wanted, present[i])
                                                    : std::clamp(wanted, lower, upper);
    if (i == 0 || i + 1 == n_) seed.pose_distance_sq += miss_of(i, wanted, seed.q[i]);
    seed.joint_distance_sq += (seed.q[i] - present[i]) * (seed.q[i] - present[i]);
  }
  return seed;
}

std::size_t SeedTable::find(const Pose& X_BG, const JointValues& present, std::span<Seed> seeds) const {
  Nearest nearest;
  nearest.wanted = std::min(seeds.size(), kMostSeeds);
  nearest.leaves = kLeavesPerSeed * nearest.wanted;
  const Placed target = place(X_BG);
  Feature offsets{};
  visit(0, target.feature, offsets, 0.0F, nearest);
  for (std::size_t i = 0; i < nearest.count; ++i) seeds[i] = seed_of(nearest.found[i], target, present);
  return nearest.count;
}

}  // namespace cellmirror::inverse_kinematics
