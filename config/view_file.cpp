#include "config/view_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <system_error>
#include <vector>

#include "config/table_reader.hpp"
#include "config/tables_file.hpp"
#include "rt_core/cell/view.hpp"

namespace cellmirror {

namespace {

constexpr Range kPlace{-kFarthestView, kFarthestView};
constexpr Range kOpeningAngle{0.0, std::numbers::pi, true, true};

// Whether the values fit those that stay is found when they are set.
void check_pairs(const TableReader& table, const ViewChange& change) {
  if (change.viewpoint && change.lookpoint && (*change.viewpoint - *change.lookpoint).norm() < kNearestLookpoint)
    table.error("viewpoint_m", "the viewpoint is the lookpoint", "choose two different points");
  if (change.near_distance && change.far_distance && *change.near_distance >= *change.far_distance)
    table.error("near_m", "the near plane is not nearer than the far plane");
}

StoredView read_view(TableReader& table, std::vector<int>& before) {
  StoredView view;
  view.id = read_new_id(table, 0, static_cast<int>(kViews) - 1, "view", before).value_or(-1);
  view.change.viewpoint = table.vector3("viewpoint_m", kPlace);
  view.change.lookpoint = table.vector3("lookpoint_m", kPlace);
  view.change.twist = table.number("twist_rad");
  view.change.opening_angle = table.number("opening_angle_rad", kOpeningAngle);
  view.change.near_distance = table.number("near_m", kNotNegative);
  view.change.far_distance = table.number("far_m", kPositive);
  view.orthogonal = table.choice<bool>("projection", {{"perspective", false}, {"parallel", true}});
  view.camera = table.text("camera").value_or("");
  if (table.has("camera") && view.camera.empty())
    table.error("camera", "the camera's name is empty", "omit the key for a view without a camera");
  view.place = table.place();
  view.camera_place = table.place("camera");
  check_pairs(table, view.change);
  table.finish();
  return view;
}

// TOML distinguishes integers from floats.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

// Names hold no quotes (TableReader::name), so a literal text holds any of them.
std::string literal(std::string_view name) { return fmt::format("'{}'", name); }

}  // namespace

std::optional<ViewFile> parse_views(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  return parse_tables<ViewFile>(text, file, diagnostics, [](TableReader& top, ViewFile& views) {
    if (auto display = top.table("display")) {
      StoredDisplay stored;
      stored.display = static_cast<int>(display->integer("layout", 1, kDisplays).value_or(1));
      stored.full_screen = display->boolean("full_screen").value_or(false);
      display->require("layout");
      display->finish();
      views.display = stored;
    }
    std::vector<int> ids;
    for (TableReader& row : top.tables("view", kViews)) views.views.push_back(read_view(row, ids));
    if (!views.display && !top.has("view"))
      top.error({}, "it has no views and no display", "add [[view]] tables, docs/cell-files.md shows them");
  });
}

std::string text_of(const Place& place) { return fmt::format("{}:{}:{}", place.file, place.line, place.column); }

std::string views_text(const DisplayState& display) {
  std::string text = "# Views of cellmirror, for LOAD_VIEWS. Metres and radians, in the world.\nformat = 1\n\n";
  text += fmt::format("[display]\nlayout = {}\nfull_screen = {}\n", display.display, display.full_screen);
  for (std::size_t id = 0; id < kViews; ++id) {
    const DisplayView& shown = display.views[id];
    const View& view = shown.view;
    text += fmt::format("\n[[view]]\nid = {}\nviewpoint_m = {}\nlookpoint_m = {}\ntwist_rad = {}\n", id,
                        vector(view.viewpoint), vector(view.lookpoint), number(view.twist));
    text += fmt::format("opening_angle_rad = {}\nnear_m = {}\nfar_m = {}\nprojection = \"{}\"\n",
                        number(view.opening_angle), number(view.near_distance), number(view.far_distance),
                        view.orthogonal ? "parallel" : "perspective");
    if (!shown.camera.empty()) text += fmt::format("camera = {}\n", literal(shown.camera));
  }
  return text;
}

std::optional<ViewFile> read_views(const std::filesystem::path& path, const std::string& shown,
                                   Diagnostics& diagnostics) {
  const auto text = text_of_file(path, kLargestViewFile, shown, diagnostics);
  return text ? parse_views(*text, shown, diagnostics) : std::nullopt;
}

Result<void> write_views(const std::filesystem::path& path, const DisplayState& display) {
  std::filesystem::path temporary = path;
  temporary += ".part";
  const std::string text = views_text(display);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "we"), std::fclose);
  const bool written = file && std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  if (!written || std::fclose(file.release()) != 0)
    return fail(fmt::format("{} cannot be written: {}", temporary.string(), std::strerror(errno)));
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) return fail(fmt::format("{} cannot be renamed: {}", temporary.string(), error.message()));
  return {};
}

}  // namespace cellmirror
