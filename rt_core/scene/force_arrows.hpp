// Arrows of forces and torques, as long as the cell's size makes them readable.
#pragma once

#include <span>

#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::scene {

// Scale of arrows, per metre of arrow: 1, 2 or 5 times a power of ten, so that the longest arrow is not longer than
// `longest_m`; smaller again only where the longest would be shorter than a fifth of that, so that the scale does not
// alternate.
class ArrowScale {
 public:
  // `largest`: N or Nm; 0 keeps the scale.
  double update(double largest, double longest_m);
  [[nodiscard]] double per_metre() const { return per_metre_; }

 private:
  double per_metre_ = 0;
};

// A label at each joint whose drive gives more than it may.
void label_overloads(const ForceState& forces, Scene& scene);

class ForceArrows {
 public:
  void draw(std::span<const ForceArrow> arrows, double longest_m, Scene& scene);
  // Units per metre of arrow; 0: none is drawn.
  [[nodiscard]] double newton_per_metre() const { return shown_force_; }
  [[nodiscard]] double newton_metre_per_metre() const { return shown_torque_; }

 private:
  ArrowScale force_;
  ArrowScale torque_;
  double shown_force_ = 0;
  double shown_torque_ = 0;
};

}  // namespace cellmirror::scene
