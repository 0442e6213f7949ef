// What somebody wants to see, checked and compared.
#pragma once

#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

// Refused, with what is allowed: more than one of view, camera and free view; what is out of range or not finite.
[[nodiscard]] Result<void> check_wish(const web::PictureWish& wish);
// Refused where the cell has no such camera; names the nearest.
[[nodiscard]] Result<void> check_camera(const web::PictureWish& wish, const CompiledCell& cell);
// One drawing serves both.
[[nodiscard]] bool same_drawing(const web::PictureWish& a, const web::PictureWish& b);

}  // namespace cellmirror::app
