// Asks FCL whether two bodies touch: an implementation that shares nothing with ours, so that a fault in one does not
// pass unseen. Only its collide() is used, which never failed in any trial; distance() may abort or loop for ever.
#pragma once

#include <cstdint>
#include <memory>

#include "rt_core/base/pose.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror::collision {

// What our own narrow phase says about two bodies.
struct OwnVerdict {
  bool touching = false;
  double distance = 0;  // m
  double depth = 0;     // m, where they touch
};

enum class Opinion : std::uint8_t {
  agrees,     // or differs within what the tolerances of both explain
  disagrees,  // one of the two is wrong
  failed,     // FCL could not tell
};

// One thread. Models of meshes are built when they are needed first (some ms for thousands of triangles) and kept.
class SecondOpinion {
 public:
  SecondOpinion();
  ~SecondOpinion();

  [[nodiscard]] Opinion ask(const Body& a, const Pose& X_WA, const Body& b, const Pose& X_WB, const OwnVerdict& own);
  // Lets go of models that are no longer used by a body of `table`.
  void keep_only(const PairTable& table);

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace cellmirror::collision
