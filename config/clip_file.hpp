// The geometry of clips (ela_clip_def). Not for the tick.
#pragma once

#include <string_view>

#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/command.hpp"

namespace cellmirror {

// Of the .mpo file `name` in envlib/ of the cell folder: its surface in the clip's frame C, the length along z and the
// width along x of the box around it. X_TC is the identity. The error is the first one of the file, with its place.
[[nodiscard]] Result<tissue::ClipDefinition> load_clip(const KismetHome& home, std::string_view name);

}  // namespace cellmirror
