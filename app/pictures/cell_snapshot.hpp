// A picture of a cell file as it is at the start, without any gateway.
#pragma once

#include <string>

#include "app/pictures/snapshot_request.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::app {

struct CellPicture {
  EncodedImage image;
  std::string renderer;  // its own name
};

// All robots at their start positions, detail levels and views as the cell file says; the startup script is not run,
// nothing is tested for collision. Refused as PictureRequest would be, and where there is no renderer.
[[nodiscard]] Result<CellPicture> cell_snapshot(const LoadedCell& loaded, const SnapshotRequest& wanted);

}  // namespace cellmirror::app
