// Any bytes as a view file: findings, or views that can be written and read again as the same.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "config/view_file.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/view.hpp"

namespace {

using namespace cellmirror;

DisplayState applied(const ViewFile& file) {
  DisplayState state;
  if (file.display) {
    state.display = file.display->display;
    state.full_screen = file.display->full_screen;
  }
  for (const StoredView& row : file.views) {
    DisplayView& shown = state.views[static_cast<std::size_t>(row.id)];
    shown.view = changed_by(shown.view, row.change);
    shown.view.orthogonal = row.orthogonal.value_or(false);
    shown.camera = row.camera;
  }
  return state;
}

// A camera is known by its name to the cell; one whose name no cell can have is not written by the gateway.
bool is_writable(const ViewFile& file) {
  return std::ranges::all_of(file.views, [](const StoredView& row) {
    return std::ranges::all_of(row.camera, [](char c) { return c > ' ' && c < 0x7F && c != '\''; });
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Diagnostics diagnostics;
  const auto file = parse_views({reinterpret_cast<const char*>(data), size}, "fuzz.vws", diagnostics);
  CELLMIRROR_EXPECTS(file.has_value() == diagnostics.ok());
  if (!file) return 0;
  CELLMIRROR_EXPECTS(file->views.size() <= kViews);
  for (const StoredView& row : file->views) CELLMIRROR_EXPECTS(check_view_id(row.id).has_value());
  const DisplayState state = applied(*file);
  CELLMIRROR_EXPECTS(state.display >= 1 && state.display <= static_cast<int>(kDisplays));
  const bool sound =
      std::ranges::all_of(state.views, [](const DisplayView& shown) { return check_view(0, shown.view).has_value(); });
  if (!sound || !is_writable(*file)) return 0;
  Diagnostics again;
  const std::string text = views_text(state);
  const auto second = parse_views(text, "fuzz.vws", again);
  CELLMIRROR_EXPECTS(second.has_value());
  CELLMIRROR_EXPECTS(views_text(applied(*second)) == text);
  return 0;
}
