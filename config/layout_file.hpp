// Layout files (.lay): how the display is divided. The format is ours: docs/cell-files.md, "Layout files". Not for the
// tick.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/display_layout.hpp"

namespace cellmirror {

inline constexpr std::string_view kLayoutExtension = ".lay";
inline constexpr std::size_t kLargestLayoutFile = 65'536;  // bytes
inline constexpr std::size_t kLongestLayoutName = 40;      // bytes, of a view or display
inline constexpr double kSmallestPane = 0.05;              // of the picture, in each direction
inline constexpr double kPaneTolerance = 1e-9;             // panes that only touch do not overlap

// Missing values are as in the standard setting. Nothing, and all diagnostics with file:line:column, where anything is
// wrong. Any bytes are allowed as text.
[[nodiscard]] std::optional<DisplayLayout> parse_layout(std::string_view text, const std::string& file,
                                                        Diagnostics& diagnostics);
// The same of a file, 65,536 bytes at most. `shown` is its name for messages.
[[nodiscard]] std::optional<DisplayLayout> read_layout(const std::filesystem::path& path, const std::string& shown,
                                                       Diagnostics& diagnostics);

}  // namespace cellmirror
