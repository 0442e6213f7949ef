// The pan-tilt head of a camera, and its angles for tracking. A head is a robot of one or two revolute joints that
// carry the camera: pan about the camera's y axis, then tilt about its x axis (docs/cameras.md).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/camera_state.hpp"
#include "rt_core/ports/display_state.hpp"

namespace cellmirror::scene {

// The slot of the robot whose joint is the nearest above the camera in the kinematic tree; none: nothing moves it but
// what it is fixed to. `camera` is an index into CompiledCell::cameras here and below.
[[nodiscard]] std::optional<std::size_t> carrier_slot(const CompiledCell& cell, std::size_t camera);

// The camera that a setting or a command means: the one with this path, else the first whose path it ends.
[[nodiscard]] std::optional<std::size_t> camera_named(const CompiledCell& cell, std::string_view name);

// Pose of the camera with its head at zero. A camera on more joints than a head has, or on none: its workframe.
[[nodiscard]] Pose mount_pose(const CompiledCell& cell, const CellPoses& poses, std::size_t camera);

struct PanTilt {
  double pan_rad = 0;   // -pi to pi
  double tilt_rad = 0;  // -pi/2 to pi/2
};
// So that z of Ry(pan) Rx(tilt) points along `direction`, given in the mount. Straight up or down, and for no direction
// at all, pan is 0.
[[nodiscard]] PanTilt pan_tilt_towards(const Eigen::Vector3d& direction_M);
[[nodiscard]] Eigen::Matrix3d rotation_of(const PanTilt& angles);

// The command to the real camera: turned towards the tracked frame whether its head is mirrored or not. A frame that is
// not in the cell counts as none.
[[nodiscard]] CameraState camera_state(const CompiledCell& cell, const CellPoses& poses, const CameraSetting& setting,
                                       std::size_t camera);
// Of all cameras that are online (CAM_ONLINE), in the order of the cell.
[[nodiscard]] std::vector<CameraState> online_cameras(const CompiledCell& cell, const CellPoses& poses,
                                                      const DisplayState& display);

}  // namespace cellmirror::scene
