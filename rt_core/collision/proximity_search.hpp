// One frame's search: which pairs touch, are within the warning distance, or are the nearest of all.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/collision/body_motion.hpp"
#include "rt_core/collision/pair_tracker.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// What is known about a pair in this frame.
struct Found {
  std::uint32_t pair = 0;  // in PairTracker::pairs()
  PairDistance at;
  bool usable = true;  // false: the pose of a body is not one that can be computed with
};

class ProximitySearch {
 public:
  void adopt(std::shared_ptr<const PairTable> table);

  // `watched`, by pair: non-zero where the distance is wanted, however large. In the order of the pairs: all that are
  // within `warning` (m) or watched, and the nearest.
  const std::vector<Found>& find(const CellPoses& poses, double warning, const std::vector<std::uint8_t>& watched);
  // Whether any pair touches; true as well where a pose is not usable.
  [[nodiscard]] bool any_touch(const CellPoses& poses);

  [[nodiscard]] const BodyMotion& motion() const { return motion_; }
  [[nodiscard]] PairTracker& tracker() { return tracker_; }
  [[nodiscard]] const PairTracker& tracker() const { return tracker_; }

 private:
  struct Candidate {
    double bound = 0;
    std::uint32_t pair = 0;
  };

  void move(const CellPoses& poses);
  void gather(double up_to, const std::vector<std::uint8_t>& watched);
  void measure(std::uint32_t pair, double up_to);
  [[nodiscard]] bool usable(const PairTracker::Tracked& pair) const;
  [[nodiscard]] double margin(const PairTracker::Tracked& pair) const;

  std::shared_ptr<const PairTable> table_;
  BodyMotion motion_;
  PairTracker tracker_;
  std::vector<Candidate> candidates_;
  std::vector<Found> found_;
  double least_ = 0;           // m, of this frame so far
  std::uint32_t nearest_ = 0;  // of the frame before, or of this one so far
  bool nearest_known_ = false;
  std::uint32_t last_touch_ = 0;  // any_touch() begins with it
};

}  // namespace cellmirror::collision
