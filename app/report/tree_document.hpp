// The tree of the cell and the names in it, for the monitor page (docs/monitor-page.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/snapshot/cell_state.hpp"

namespace cellmirror::app {

[[nodiscard]] std::string tree_document(const CellState& cell_state, std::uint64_t tree_revision);

// `home`: of the cell; the scripts and view files in its scripts/ are listed.
[[nodiscard]] std::string names_document(const CellState& cell_state, const std::filesystem::path& home);

// Names of the files in a folder and below that have this extension, sorted, without it where `bare`; a bounded number,
// links are not followed.
[[nodiscard]] std::vector<std::string> files_with(const std::filesystem::path& folder, std::string_view extension,
                                                  bool bare);

}  // namespace cellmirror::app
