// The cell as a gateway takes it from its file: with what its command line says instead, findings in the log.
#pragma once

#include <filesystem>
#include <vector>

#include "app/gateway/gateway.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

[[nodiscard]] Result<LoadedCell> load_cell_of(const GatewayOptions& options);
// The cell file first (an absolute path), then what it refers to, and the files of scripts/.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const LoadedCell& cell);

}  // namespace cellmirror::app
