// Distances of pairs of bodies that move in small steps: what was found out about a pair holds on, less how far its
// bodies have moved since, so that most pairs need a subtraction a frame and few a query.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/collision/body_motion.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::collision {

struct PairDistance {
  double distance = 0;  // m; 0: they touch
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();
  bool beyond = false;    // `distance` is only a lower bound, the points are not set
  bool certain = true;    // false: `distance` is a lower bound that may be a little too small
  bool plausible = true;  // false: the answer contradicts itself; taken as a touch
};

class PairTracker {
 public:
  static constexpr std::size_t kMostContactPoints = 8;

  // Only tested pairs are kept, in the order of the table.
  void adopt(const PairTable& table, const BodyMotion& motion);

  // After BodyMotion::restart().
  void forget_bounds();

  struct Tracked {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double known = 0;  // m; a lower bound of the distance, plus how far both had travelled when it was known
  };
  [[nodiscard]] const std::vector<Tracked>& pairs() const { return pairs_; }

  // A lower bound of the distance, m. Minus infinity where a body is not usable.
  [[nodiscard]] double bound(const Tracked& pair, const std::vector<double>& travelled) const {
    return pair.known - travelled[pair.a] - travelled[pair.b];
  }
  // A better bound, by boxes and by the motion of one relative to the other; stops where it is above `enough`.
  double refine(std::size_t index, double enough);
  // The distance where it is below `up_to`, else a lower bound that is not below `up_to`. Bodies that are usable.
  const PairDistance& distance(std::size_t index, double up_to);
  // Deepest first, at most kMostContactPoints, of a pair that touches; no points where no part touches another. Valid
  // until the next call for that pair.
  const geometry::Contact& contact(std::size_t index);
  // What contact() found last, and in which frame: 0 if it was not called.
  [[nodiscard]] const geometry::Contact& last_contact(std::size_t index) { return memory_of(index).contact; }
  [[nodiscard]] std::uint64_t contact_frame(std::size_t index) { return memory_of(index).contact_frame; }
  // Stops at the first touch.
  [[nodiscard]] bool touches(std::size_t index);

  [[nodiscard]] std::uint64_t queries() const { return queries_; }

 private:
  // Two parts of a pair.
  struct Item {
    std::uint32_t part_a = 0;
    std::uint32_t part_b = 0;
    double known = 0;
    geometry::ProximityHint hint;
  };
  struct Memory {
    std::vector<Item> items;
    // One body in the other at the last query.
    Eigen::Matrix3d R_then = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p_then = Eigen::Vector3d::Zero();
    double distance_then = -1;  // m, a lower bound; below 0: there was no query
    PairDistance last;
    double up_to = 0;         // m, how far the query of `last` looked
    std::uint64_t frame = 0;  // of `last`, 0: none
    geometry::Contact contact;
    std::uint64_t contact_frame = 0;  // of `contact`, 0: none
  };
  struct Candidate {
    double bound = 0;
    std::uint32_t item = 0;
  };

  Memory& memory_of(std::size_t index);
  [[nodiscard]] std::uint64_t moved_frame(const Tracked& pair) const;
  void gather(const Tracked& pair, Memory& memory, double up_to);
  void measure(const Tracked& pair, Memory& memory, double up_to);
  void relative(const Tracked& pair, Eigen::Matrix3d& R, Eigen::Vector3d& p) const;

  const BodyMotion* motion_ = nullptr;
  std::vector<Tracked> pairs_;
  std::vector<std::unique_ptr<Memory>> memory_;  // made when the pair comes near for the first time
  std::vector<Candidate> candidates_;
  geometry::Contact part_contact_;
  std::uint64_t queries_ = 0;
};

}  // namespace cellmirror::collision
