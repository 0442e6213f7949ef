// Reads the tetrahedra of a Gmsh file (.msh): formats 1, 2.0 to 2.2 and 4.1, ASCII and binary in either byte order. The
// file is untrusted. Not for the tick: O(n log n) with heap memory. Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::msh {

inline constexpr std::size_t kMostNodes = 2'000'000;
inline constexpr std::size_t kMostElements = 2'000'000;               // of all kinds
inline constexpr std::size_t kLargestFile = std::size_t{256} << 20U;  // bytes
inline constexpr double kLargestCoordinate = 1e6;                     // m, after scaling
// Tetrahedra whose volume is less than this part of a cube over their longest edge have none. Files carry six digits.
inline constexpr double kLeastShape = 1e-6;

// The tetrahedra, with the nodes that they use, times `scale`; or nothing, and why, with file:line:column in ASCII and
// the byte's number in binary files. Points, lines and surface elements are left out; hexahedra, prisms and pyramids
// too, with a warning. Inverted tetrahedra are turned, with a note. Refused: elements of second and higher order, ids
// that appear twice, unknown nodes, coordinates that are not finite, tetrahedra without volume, faces that belong to
// more than two tetrahedra, and neighbours that overlap.
[[nodiscard]] std::optional<tissue::TetraMesh> parse_msh(std::string_view bytes, const std::string& file, double scale,
                                                         Diagnostics& diagnostics);
// The same of a file.
[[nodiscard]] std::optional<tissue::TetraMesh> read_msh(const std::filesystem::path& path, double scale,
                                                        Diagnostics& diagnostics);

}  // namespace cellmirror::msh
