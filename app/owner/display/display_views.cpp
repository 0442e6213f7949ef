// Of DisplayService, view files: LOAD_VIEWS and SAVE_VIEWS.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "app/owner/display/display_service.hpp"
#include "config/view_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kFolder = "scripts";

Error first_finding(const Diagnostics& findings) {
  for (const Diagnostic& finding : findings.all()) {
    if (finding.severity != Severity::error) continue;
    const std::size_t more = findings.errors() - 1;
    const std::string rest = more == 0 ? "" : fmt::format(" (and {} more: `cellmirror check` shows all)", more);
    return {fmt::format("{}: {}{}", text_of(finding.place), finding.message, rest), finding.remedy};
  }
  return {"the view file cannot be read", {}};
}

Result<void> at(const Place& place, const Error& error) {
  return fail(fmt::format("{}: {}", text_of(place), error.what), error.remedy);
}

}  // namespace

// All of it or nothing.
Result<void> DisplayService::load_views(std::string_view file) {
  const auto path = parts_.home.file(kFolder, file, kViewExtension);
  if (!path) return std::unexpected(path.error());
  Diagnostics findings;
  const auto stored = read_views(*path, path->filename().string(), findings);
  if (!stored) {
    Error why = first_finding(findings);
    if (path->extension() != kViewExtension)
      why.what = fmt::format("{} is no view file ({}): {}", printable(file), kViewExtension, why.what);
    return std::unexpected(std::move(why));
  }
  follow_cell();
  std::array<DisplayView, kViews> views = state_.views;
  for (const StoredView& row : stored->views) {
    DisplayView& shown = views[static_cast<std::size_t>(row.id)];
    shown.view = changed_by(shown.view, row.change);
    shown.view.orthogonal = row.orthogonal.value_or(shown.view.orthogonal);
    shown.sequence.reset();
    shown.camera.clear();
    shown.front_plane_set = false;
    if (const auto checked = check_view(row.id, shown.view); !checked) return at(row.place, checked.error());
    if (row.camera.empty()) continue;
    auto camera = camera_name(row.camera);
    if (!camera) return at(row.camera_place, camera.error());
    shown.camera = *std::move(camera);
  }
  state_.views = std::move(views);
  if (stored->display) {
    state_.display = stored->display->display;
    state_.full_screen = stored->display->full_screen;
  }
  changed();
  return {};
}

// Nothing but view files is ever replaced: a name with another extension is refused.
Result<void> DisplayService::save_views(std::string_view file) {
  if (file.starts_with('.') && file.find('/') == std::string_view::npos)
    return fail(fmt::format("{} is no name for a view file", printable(file)), "give a name that begins with a letter");
  const std::filesystem::path name(file);
  const std::string extension = name.extension().string();
  if (!extension.empty() && extension != kViewExtension)
    return fail(fmt::format("views are saved as {} files, not as {}", kViewExtension, printable(file)),
                fmt::format("e.g. SAVE_VIEWS {}{}", printable(name.stem().string()), kViewExtension));
  const std::string whole = std::string(file) + (extension.empty() ? std::string(kViewExtension) : std::string());
  const auto path = parts_.home.file_to_write(kFolder, whole);
  if (!path) return std::unexpected(path.error());
  return write_views(*path, state_);
}

}  // namespace cellmirror::app
