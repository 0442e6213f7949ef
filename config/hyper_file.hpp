// Hyper files (.hyper) of eladyn_hyper_name: what connects deformable objects, as TOML; docs/cell-files.md describes
// the keys. Any bytes are allowed as text. Not for the tick.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/tissue_setup.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror {

// `objects`: the names of the cell's objects, so that others are errors; null where the cell is unknown.
[[nodiscard]] std::optional<tissue::HyperDescription> parse_hyper(std::string_view text, const std::string& file,
                                                                  const std::vector<std::string>* objects,
                                                                  Diagnostics& diagnostics);
// The same of a file.
[[nodiscard]] std::optional<tissue::HyperDescription> read_hyper(const std::filesystem::path& path,
                                                                 const std::vector<std::string>* objects,
                                                                 Diagnostics& diagnostics);
// Of the file `name` in envlib/ of the cell folder, for a cell with objects of these names. The error is the first one
// of the file, with its place, and how many there are.
[[nodiscard]] Result<tissue::HyperDescription> load_hyper(const KismetHome& home, std::string_view name,
                                                          const std::vector<std::string>& objects);

}  // namespace cellmirror
