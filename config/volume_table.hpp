// Reads [volume] of a component file. Private to this folder.
#pragma once

#include <optional>

#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror {

// `of_source`: what is wrong with the source, at the place of its name or in a file of its own.
[[nodiscard]] std::optional<ComponentVolume> read_volume_table(TableReader& component, const FileFinder& files,
                                                               Diagnostics& of_source);

}  // namespace cellmirror
