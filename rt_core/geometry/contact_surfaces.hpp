// Where and how deep surfaces run below each other: contact of bodies that are not both convex. In bounded time: of
// large contacts an evenly spread sample is examined, so the depth is that of the sample.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/mesh_tree.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::geometry {

inline constexpr std::size_t kMostContactPairs = 4096;   // triangles of one with triangles of the other
inline constexpr std::size_t kMostContactSamples = 256;  // points of each body that are tested for depth

// Collects evenly spread parts of a stream of unknown length: of more than `most`, every second is dropped, and so on.
template <class T>
class EvenSample {
 public:
  explicit EvenSample(std::size_t most) : most_(most) { kept_.reserve(most); }

  void clear() {
    kept_.clear();
    step_ = 1;
    seen_ = 0;
  }
  void offer(const T& value) {
    if (seen_++ % step_ != 0) return;
    if (kept_.size() == most_) {
      for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = kept_[2 * i];
      kept_.resize((kept_.size() + 1) / 2);
      step_ *= 2;
      if ((seen_ - 1) % step_ != 0) return;
    }
    kept_.push_back(value);
  }
  [[nodiscard]] const std::vector<T>& kept() const { return kept_; }

 private:
  std::size_t most_;
  std::vector<T> kept_;
  std::size_t step_ = 1;
  std::size_t seen_ = 0;
};

// Both append to `points`, which are in A's (the mesh's) frame, with normals from A to B. A point of depth 0 may have
// no normal (zero).
void mesh_mesh_contact(const MeshTree& a, const MeshTree& b, const Pose& X_AB, std::vector<ContactPoint>& points);
void mesh_primitive_contact(const MeshTree& mesh, const ConvexCore& primitive, const Pose& X_MP,
                            std::vector<ContactPoint>& points);

}  // namespace cellmirror::geometry
