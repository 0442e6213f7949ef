// The seven views of the display (manual 1.2.3, COVW): viewpoint and projection. Plain data, SI; no drawing. Any
// thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/view.hpp"
#include "rt_core/ports/view_change.hpp"

namespace cellmirror {

// The axes of the screen in the world: x to the right, y up, z out of the screen towards the viewer. The world's z is
// up on the screen before the twist; in a view straight up or down, its y is.
[[nodiscard]] Eigen::Matrix3d screen_axes(const View& view);

// Corners of a box about all that the cell draws, at the joint positions q[slot][joint]; a
// box of 2 m above the origin for an empty cell.
struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d(-1, -1, 0);
  Eigen::Vector3d high = Eigen::Vector3d(1, 1, 2);
};
[[nodiscard]] Extent extent_of(const CompiledCell& cell, std::span<const JointValues> q);

inline constexpr double kFarthestView = 10'000.0;  // m: of viewpoints and lookpoints, in each coordinate
inline constexpr double kNearestLookpoint = 1e-6;  // m, from the viewpoint

// Views that show the whole extent from where the layout has them, in a picture of 4 to 3; those that the layout shows
// in a narrower pane, in that.
[[nodiscard]] std::array<View, kViews> views_of_extent(const Extent& extent, const DisplayLayout& layout = {});

// Refused: another id than 0 to 6.
[[nodiscard]] Result<void> check_view_id(int id);
// Refused as well: values that are not finite or beyond 10 km, a viewpoint on the lookpoint, an opening angle outside
// of 0..pi, clipping planes that leave nothing between them.
[[nodiscard]] Result<void> check_view(int id, const View& view);
[[nodiscard]] View changed_by(View view, const ViewChange& change);

}  // namespace cellmirror
