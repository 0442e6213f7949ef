// Turns the text of a component file or a URDF into a Component. No file is opened but by the FileFinder: to see
// whether named ones exist, and to read colliding meshes. All diagnostics in one pass; any bytes are allowed as text.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/file_finder.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestText = 16UL << 20U;  // bytes of a cell, component or URDF file

// The valid part, even with errors; nothing if the text is not TOML or XML.
[[nodiscard]] std::optional<Component> parse_component(std::string_view text, const std::string& file,
                                                       const FileFinder& files, Diagnostics& diagnostics);
// `path` is the path of the URDF, for its meshes.
[[nodiscard]] std::optional<Component> parse_urdf(std::string_view text, const std::string& file,
                                                  const std::filesystem::path& path, const FileFinder& files,
                                                  Diagnostics& diagnostics);

// The same for the chains from the root to two links, without bodies: the rest of the robot may exceed the capacities
// and have errors. Speeds and efforts may be missing.
[[nodiscard]] std::optional<Component> parse_urdf_between(std::string_view text, const std::string& file,
                                                          std::string_view base, std::string_view tip,
                                                          Diagnostics& diagnostics);

// Appends diagnostics in the order of their places in the file.
void take_sorted(Diagnostics& to, const Diagnostics& from);

}  // namespace cellmirror
