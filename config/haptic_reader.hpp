// Reads [[haptic]] tables. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "config/cell_file.hpp"
#include "config/component_files.hpp"
#include "config/table_reader.hpp"

namespace cellmirror {

// `complete`: all robots of the cell are in `robots`, so that an unknown one is an error.
[[nodiscard]] std::optional<RobotHaptic> read_haptic(TableReader& reader, const RobotDirectory& robots, bool complete);

// "0600": permissions as people write them.
[[nodiscard]] std::optional<std::uint32_t> octal(std::string_view text);

}  // namespace cellmirror
