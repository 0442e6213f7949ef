// Reads [display] of a cell file. Private to this folder.
#pragma once

#include "config/picture_settings.hpp"
#include "config/table_reader.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

[[nodiscard]] PictureSettings read_display(TableReader& top);

// The keys of [dds_output] about pictures.
void read_dds_pictures(TableReader& table, DdsPictureConfig& config);

}  // namespace cellmirror
