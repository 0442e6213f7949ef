// Reads [record] of a cell file. Private to this folder.
#pragma once

#include "config/record_settings.hpp"
#include "config/table_reader.hpp"

namespace cellmirror {

[[nodiscard]] RecordSettings read_record(TableReader& top);

}  // namespace cellmirror
