// Postures of a chain, found by the pose of the tip: where a search should start. Internal to the folder.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/kinematics/chain.hpp"

namespace cellmirror::inverse_kinematics {

struct Seed {
  JointValues q{};               // within the limits
  double pose_distance_sq = 0;   // squared, lengths in units of half the reach, directions as they are
  double joint_distance_sq = 0;  // squared, to the present posture
};

// Turning the first joint turns the whole arm about a fixed axis, and turning the last one turns the tip about itself.
// So neither is sampled: entries are sampled over the joints between, and found by what these two cannot change, how
// the last axis lies to the first one (four dimensions: the distance and height of a point on the last axis, and two
// angles of its direction). A first joint that slides is left out in the same way. The values of the first and the last
// joint then follow from the target. Entries lie in a k-d tree (Bentley 1975).
//
// Deterministic: postures are a low-discrepancy sequence within the limits. Immutable; any number of readers.
class SeedTable {
 public:
  static constexpr std::size_t kEntries = 24'000;
  static constexpr std::size_t kMostSeeds = 128;

  // Some 15 ms and 1.5 MB.
  explicit SeedTable(const kinematics::Chain& chain, std::size_t entries = kEntries);

  // The entries that come nearest to X_BG, nearest first, each with its turns chosen nearest to `present`; returns
  // their number, at most seeds.size() and kMostSeeds. 16 take about 1 us. No heap.
  std::size_t find(const Pose& X_BG, const JointValues& present, std::span<Seed> seeds) const;

 private:
  static constexpr std::size_t kFeatures = 6;
  static constexpr std::size_t kLeaf = 8;
  using Feature = std::array<float, kFeatures>;

  struct Entry {
    std::array<float, kinematics::kMaxVariables> q{};
    float azimuth = 0;         // rad, of the point on the last axis about the first axis at q[0] = 0
    std::array<float, 3> x{};  // x axis of the last joint's frame at value 0, in the first joint's frame at value 0
  };
  struct Leaf {
    std::array<std::array<float, kLeaf>, kFeatures> feature{};
    std::array<std::uint32_t, kLeaf> entry{};
  };
  struct Node {
    float split = 0;
    std::uint8_t dimension = 0;
  };
  struct Placed {  // a pose in the table's coordinates
    Feature feature{};
    double azimuth = 0;
    double slide = 0;                                 // along the first axis
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // of the last joint's frame in the first one's, both at rest
  };
  struct Near {
    float distance_sq = 0;
    std::uint32_t entry = 0;
  };
  struct Nearest;

  [[nodiscard]] Placed place(const Pose& X_BT) const;
  void sample(std::size_t entries);
  void build(std::size_t node, std::span<std::uint32_t> indices, const std::vector<Feature>& features);
  void visit(std::size_t node, const Feature& wanted, Feature& offsets, float bound, Nearest& nearest) const;
  [[nodiscard]] double miss_of(std::size_t variable, double wanted, double got) const;
  [[nodiscard]] Seed seed_of(const Near& near, const Placed& target, const JointValues& present) const;

  kinematics::Chain chain_;
  std::size_t n_;
  bool first_turns_ = false;  // the first joint is left out of the sampling because it turns
  bool first_slides_ = false;
  bool last_turns_ = false;
  double length_ = 1;
  Pose X_FB_ = Pose::Identity();  // base in the first joint's frame at value 0
  Pose X_TL_ = Pose::Identity();  // the last joint's frame in the tip
  std::vector<Entry> entries_;
  std::vector<Node> nodes_;  // a complete binary tree: children of i are 2i+1 and 2i+2; leaves follow
  std::vector<Leaf> leaves_;
};

}  // namespace cellmirror::inverse_kinematics
