// Reads [web] of a cell file. Private to this folder.
#pragma once

#include <string>

#include "config/table_reader.hpp"
#include "config/web_settings.hpp"

namespace cellmirror {

[[nodiscard]] WebSettings read_web(TableReader& top);

// The keys `address` and `allow_remote` of any page; `otherwise` where there is none.
[[nodiscard]] std::string read_page_address(TableReader& table, const std::string& otherwise);

}  // namespace cellmirror
