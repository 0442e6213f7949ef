// Where the bodies of a pair table are, and how far they have come since then.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/bounds.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

struct MovingPart {
  const geometry::Solid* solid = nullptr;
  Pose X_NG = Pose::Identity();
  OrientedBox box;
  Pose X_WG = Pose::Identity();
  PlacedBox placed;
};

struct MovingBody {
  std::int32_t node = 0;
  std::uint32_t first_part = 0;
  std::uint32_t part_count = 0;
  OrientedBox box;
  Pose X_WN = Pose::Identity();
  PlacedBox placed;
  double step = 0;                // m, in the last frame: at most how far any of its points moved
  std::uint64_t moved_frame = 0;  // the last in which its pose changed
  bool usable = false;            // its pose is one that can be computed with
};

class BodyMotion {
 public:
  void adopt(std::shared_ptr<const PairTable> table);
  // A new frame. No heap memory.
  void move(const CellPoses& poses);

  [[nodiscard]] std::uint64_t frame() const { return frame_; }
  [[nodiscard]] const std::vector<MovingBody>& bodies() const { return bodies_; }
  [[nodiscard]] const MovingPart& part(const MovingBody& body, std::size_t index) const {
    return parts_[body.first_part + index];
  }
  // By body, m: the length of the way of its points since adopt(), at most; infinite where it is not usable.
  [[nodiscard]] const std::vector<double>& travelled() const { return travelled_; }
  [[nodiscard]] std::size_t unusable() const { return unusable_; }
  // The sums of travelled() grow so large that they begin to lose digits: what is known should be forgotten.
  [[nodiscard]] bool worn() const { return worn_; }
  void restart();

 private:
  void place(std::size_t index, const Pose& X_WN);

  std::shared_ptr<const PairTable> table_;
  std::vector<MovingBody> bodies_;
  std::vector<MovingPart> parts_;
  std::vector<double> way_;        // by body, m; kept while it is not usable
  std::vector<double> travelled_;  // as told
  std::uint64_t frame_ = 0;
  std::size_t unusable_ = 0;
  bool worn_ = false;
};

}  // namespace cellmirror::collision
