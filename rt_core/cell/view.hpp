// The seven views of the display (manual 1.2.3, COVW): from where and how the cell is looked at. Plain data, SI; no
// drawing. One thread: the owner of the cell.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/view.hpp"
#include "rt_core/ports/view_change.hpp"

namespace cellmirror {

// The axes of the screen in the world: x to the right, y up, z out of the screen towards the viewer. The world's z is
// up on the screen before the twist; in a view straight up or down, its y is.
[[nodiscard]] Eigen::Matrix3d screen_axes(const View& view);

// Corners of a box about all that the cell draws, at the joint positions q[slot][joint]; of meshes the place alone. A
// box of 2 m about the origin for an empty cell.
struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d(-1, -1, 0);
  Eigen::Vector3d high = Eigen::Vector3d(1, 1, 2);
};
[[nodiscard]] Extent extent_of(const CompiledCell& cell, std::span<const JointValues> q);

class Views {
 public:
  static constexpr int kViews = 7;
  static constexpr int kDisplays = 6;

  // Views that show the whole extent: 0 perspective, 1 and 3 from above, 2 and 4 from the side (-y), 5 from the side in
  // perspective, 6 bird's eye.
  explicit Views(const Extent& extent);

  [[nodiscard]] const View& view(int id) const { return views_[static_cast<std::size_t>(id)]; }
  // Refused: another id than 0 to 6, values that are not finite or beyond 10 km, a viewpoint on the lookpoint, an
  // opening angle outside of 0..pi, clipping planes that leave nothing between them.
  Result<void> set(int id, const View& view);
  Result<void> change(int id, const ViewChange& change);

  // 1 to 6 (STDP). The first view of the display is the current one.
  Result<void> set_display(int display, bool full_screen);
  [[nodiscard]] int display() const { return display_; }
  [[nodiscard]] bool full_screen() const { return full_screen_; }
  [[nodiscard]] int current_id() const;
  [[nodiscard]] const View& current() const { return view(current_id()); }

 private:
  std::array<View, kViews> views_;
  int display_ = 1;
  bool full_screen_ = false;
};

}  // namespace cellmirror
