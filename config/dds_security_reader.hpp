// Reads [dds.security] of a cell file. Private to this folder.
#pragma once

#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

// Not enabled without the table. Errors: files that are missing or outside of the cell folder; a private key that
// others may read.
[[nodiscard]] DdsSecurityConfig read_dds_security(TableReader& top, const FileFinder& files);

}  // namespace cellmirror
