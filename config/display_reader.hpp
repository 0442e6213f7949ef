// Reads [display] of a cell file. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>

#include "config/file_finder.hpp"
#include "config/picture_settings.hpp"
#include "config/table_reader.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

// `layout_file`: where it is, if one is named and found.
[[nodiscard]] PictureSettings read_display(TableReader& top, const FileFinder& files,
                                           std::optional<std::filesystem::path>& layout_file);

// The keys of [dds_output] about pictures.
void read_dds_pictures(TableReader& table, DdsPictureConfig& config);

}  // namespace cellmirror
