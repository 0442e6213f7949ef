// Turns the text of a component file or a URDF into a Component. No file is opened but by the FileFinder: to see
// whether named ones exist, and to read the meshes of what collides. All findings in one pass; any bytes are allowed as
// text.
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

// What could be understood, even where there are findings; nothing where the text is no TOML or XML at all.
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

// Appends findings in the order of their places in the file.
void take_sorted(Diagnostics& to, const Diagnostics& from);

}  // namespace cellmirror
