// Names of bodies in results and records: shorter than full paths, equally unique, and accepted in place of a path. Not
// for the tick.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror {

// One for each of `paths`: its first and last name ("Mantec_1.J_4" for "Mantec_1.J_1.J_2.J_3.J_4") where these name no
// other of `all`, full paths of a cell; else one of the names between them as well; else the path itself. `paths` are
// among `all`. Not longer than 127 bytes where any two names of the path would do.
[[nodiscard]] std::vector<std::string> short_names(std::span<const std::string> paths,
                                                   std::span<const std::string> all);

// Name of a node's geometry in results: its full path; for the cell's own geometry the name of the cell.
[[nodiscard]] const std::string& body_name(const CompiledCell& cell, std::int32_t node);
// The same in short, for each of `nodes`.
[[nodiscard]] std::vector<std::string> short_body_names(const CompiledCell& cell, std::span<const std::int32_t> nodes);

}  // namespace cellmirror
