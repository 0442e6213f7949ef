// Reads [web] of a cell file. Private to this folder.
#pragma once

#include "config/table_reader.hpp"
#include "config/web_settings.hpp"

namespace cellmirror {

[[nodiscard]] WebSettings read_web(TableReader& top);

}  // namespace cellmirror
