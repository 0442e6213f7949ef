// Checks the files that describe a CAN bus.
#pragma once

#include <filesystem>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::app {

[[nodiscard]] bool is_bus_file(const std::filesystem::path& path);  // by extension: .dbc .eds .dcf
void check_bus_file(const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace cellmirror::app
