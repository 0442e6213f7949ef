// Checks with FCL whether two bodies touch: an independent implementation, so that a fault in either is detected. Only
// its collide() is used, which never failed in tests; distance() may abort or loop forever.
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
  failed,     // FCL could not decide
};

// One thread. Models of meshes are built when they are needed first (some ms for thousands of triangles) and kept.
class SecondOpinion {
 public:
  SecondOpinion();
  ~SecondOpinion();

  [[nodiscard]] Opinion ask(const Body& a, const Pose& X_WA, const Body& b, const Pose& X_WB, const OwnVerdict& own);
  // Releases models that no body of `table` uses.
  void keep_only(const PairTable& table);

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace cellmirror::collision
