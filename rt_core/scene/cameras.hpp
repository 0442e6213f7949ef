// Poses and views of the cell's cameras. The optical axis is the z axis of the workframe; x points right in the image,
// y down (docs/cell-files.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/display_state.hpp"

namespace cellmirror::scene {

struct CameraNow {
  std::size_t camera = 0;  // index into CompiledCell::cameras
  Pose X_WC = Pose::Identity();
  double focal_distance_m = 0;  // viewing distance; of a tracking camera the distance to what it tracks
  double fovy_rad = 0;
  double housing_m = 0;   // how far its own housing reaches before it: a picture begins behind that
  bool tracking = false;  // CAM_TRACKING, and the frame is there
  double pan_rad = 0;     // how far tracking turned it out of its mount (camera_mount.hpp), about its y axis,
  double tilt_rad = 0;    // then about its new x axis; 0 for others
};

// A camera that tracks (CAM_TRACKING) is turned about its own position until its z axis meets the origin of the frame
// it tracks; but one whose head is mirrored stays as it is: its picture shows what the real one sees. `name`: of its
// workframe, or the full path. No camera of that name: none.
[[nodiscard]] std::optional<CameraNow> camera_now(const CompiledCell& cell, const CellPoses& poses,
                                                  const DisplayState& display, std::string_view name);
// As Pane::camera names it.
[[nodiscard]] std::uint32_t object_of_camera(const CompiledCell& cell, const CameraNow& camera);
// Of all cameras, in the order of the cell.
[[nodiscard]] std::vector<CameraNow> cameras_now(const CompiledCell& cell, const CellPoses& poses,
                                                 const DisplayState& display);

}  // namespace cellmirror::scene
