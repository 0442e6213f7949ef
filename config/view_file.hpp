// View files (.vws) of LOAD_VIEWS and SAVE_VIEWS. The format is ours: docs/cell-files.md, "View files". Not for the
// tick.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/view_change.hpp"

namespace cellmirror {

inline constexpr std::string_view kViewExtension = ".vws";
inline constexpr std::size_t kLargestViewFile = 65'536;  // bytes

// A view as a file has it; what is not given stays.
struct StoredView {
  int id = 0;  // 0 to 6
  ViewChange change;
  std::optional<bool> orthogonal;
  std::string camera;  // COVW; empty: the view is its own
  Place place;         // where it stands
  Place camera_place;  // of the camera's name
};

struct StoredDisplay {
  int display = 1;  // STDP
  bool full_screen = false;
};

struct ViewFile {
  std::optional<StoredDisplay> display;
  std::vector<StoredView> views;  // each of another id
};

// "a.vws:3:5", as in diagnostics.
[[nodiscard]] std::string text_of(const Place& place);

// Nothing, and all diagnostics with file:line:column, after any error. Any bytes are allowed as text.
[[nodiscard]] std::optional<ViewFile> parse_views(std::string_view text, const std::string& file,
                                                  Diagnostics& diagnostics);
// parse_views() of it gives the very same numbers again.
[[nodiscard]] std::string views_text(const DisplayState& display);

// The same of a file, 65,536 bytes at most. `shown` is its name for messages.
[[nodiscard]] std::optional<ViewFile> read_views(const std::filesystem::path& path, const std::string& shown,
                                                 Diagnostics& diagnostics);
// Replaces the file as a whole or leaves it as it was.
[[nodiscard]] Result<void> write_views(const std::filesystem::path& path, const DisplayState& display);

}  // namespace cellmirror
