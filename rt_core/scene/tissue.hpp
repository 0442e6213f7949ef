// Deforming objects in a scene: how their surfaces are drawn, and of their network the forces and central nodes.
#pragma once

#include <memory>
#include <span>

#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/scene.hpp"
#include "rt_core/scene/force_arrows.hpp"

namespace cellmirror::scene {

class TissueMarks {
 public:
  // Replaces the scene's tissue and its draw modes; adds arrows and axes. `rules` name an object as SCRIPT does. Null:
  // there is none.
  void draw(const std::shared_ptr<const TissueView>& view, std::span<const DrawRule> rules, Scene& scene);
  // N per metre of arrow; 0: none is drawn.
  [[nodiscard]] double newton_per_metre() const { return shown_; }

 private:
  void draw_forces(const TissueView& view, double longest_m, Scene& scene);

  ArrowScale scale_;
  double shown_ = 0;
};

// What the colours of a network's nodes mean, of those that occur.
void write_network_legend(const TissueView& view, const TissueMarks& marks, Scene& scene);

}  // namespace cellmirror::scene
