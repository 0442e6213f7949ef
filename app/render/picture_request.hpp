// Validation and comparison of requests for pictures.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

// Refused, with what is allowed: more than one of view, camera and free view; what is out of range or not finite.
[[nodiscard]] Result<void> check_request(const PictureRequest& request);
// Refused where the cell has no such camera; names the nearest.
[[nodiscard]] Result<void> check_camera(const PictureRequest& request, const CompiledCell& cell);
// One drawing serves both.
[[nodiscard]] bool same_drawing(const PictureRequest& a, const PictureRequest& b);

}  // namespace cellmirror::app
