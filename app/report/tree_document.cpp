#include "app/report/tree_document.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/report/live_volumes.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kMostNames = 5000;

// "frame", "joint", "workframe", "camera" or "sensor" for each node.
std::vector<std::string_view> kinds_of(const CompiledCell& cell) {
  std::vector<std::string_view> kinds(cell.size(), "frame");
  const auto set = [&](std::int32_t node, std::string_view kind) { kinds.at(static_cast<std::size_t>(node)) = kind; };
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (cell.joint_of[i] >= 0) kinds[i] = "joint";
  }
  for (const std::int32_t node : cell.workframes) set(node, "workframe");
  for (const CompiledCamera& camera : cell.cameras) set(camera.node, "camera");
  for (const CompiledSensor& sensor : cell.sensors) set(sensor.node, "sensor");
  return kinds;
}

std::string_view shown_word(Shown shown) {
  switch (shown) {
    case Shown::hidden:
      return "hidden";
    case Shown::coarse:
      return "coarse";
    case Shown::detail:
      break;
  }
  return "detail";
}

std::string_view bare_name(std::string_view path) { return path.substr(path.rfind('.') + 1); }

void add_names(JsonWriter& out, std::string_view key, const std::vector<std::string>& names) {
  out.key(key).begin_array();
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) out.value(names[i]);
  out.end_array();
}

}  // namespace

std::string tree_document(const CellState& cell_state, std::uint64_t tree_revision) {
  const CompiledCell& cell = *cell_state.cell;
  const std::vector<std::string>& paths = *cell.paths;
  const std::vector<std::string_view> kinds = kinds_of(cell);
  std::vector<std::string_view> robots(cell.size());
  for (const CompiledRobot& robot : cell.robots) robots.at(static_cast<std::size_t>(robot.component)) = robot.id;
  std::vector<std::size_t> order(cell.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::string_view(paths[i]); });
  JsonWriter out;
  out.begin_object().member("revision", tree_revision).key("nodes").begin_array();
  for (const std::size_t i : order) {
    const std::int32_t parent = cell.naming_parent[i];
    out.begin_object().member("path", paths[i]).member("name", bare_name(paths[i])).key("parent");
    if (parent >= 0) {
      out.value(paths[static_cast<std::size_t>(parent)]);
    } else {
      out.null();
    }
    out.member("kind", kinds[i]).member("shown", cell.visible[i] != 0);
    const NodeLevel level = cell_state.levels && i < cell_state.levels->size() ? (*cell_state.levels)[i] : NodeLevel{};
    out.member("has_detail", level.has_detail).member("level", shown_word(level.shown));
    if (!robots[i].empty()) out.member("robot", robots[i]);
    out.end_object();
  }
  out.end_array();
  add_volume_contents(out, cell_state);
  return out.end_object().take();
}

std::vector<std::string> files_with(const std::filesystem::path& folder, std::string_view extension, bool bare) {
  constexpr int kMostEntries = 10'000;
  constexpr int kDeepest = 8;
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::recursive_directory_iterator at(folder, std::filesystem::directory_options::skip_permission_denied,
                                                   error);
  const std::filesystem::recursive_directory_iterator end;
  for (int seen = 0; !error && at != end && seen < kMostEntries; at.increment(error), ++seen) {
    if (at.depth() >= kDeepest) at.disable_recursion_pending();
    std::filesystem::path name = at->path().lexically_relative(folder);
    std::error_code ignored;
    if (name.extension() != extension || !at->is_regular_file(ignored)) continue;
    if (bare) name.replace_extension();
    names.push_back(name.string());
  }
  std::ranges::sort(names);
  return names;
}

std::string names_document(const CellState& cell_state, const std::filesystem::path& home) {
  const CompiledCell& cell = *cell_state.cell;
  const std::vector<std::string>& paths = *cell.paths;
  const std::vector<std::string_view> kinds = kinds_of(cell);
  std::vector<std::string> robots;
  std::vector<std::string> frames;
  std::vector<std::string> workframes;
  std::vector<std::string> cameras;
  std::vector<std::string> sensors;
  for (const CompiledRobot& robot : cell.robots) robots.push_back(robot.id);
  // As commands and the display name them: two of one name by their paths.
  for (const CameraSetting& camera : cell_state.display->cameras) cameras.push_back(camera.name);
  for (const CompiledSensor& sensor : cell.sensors) sensors.push_back(sensor.name);
  for (std::size_t i = 1; i < cell.size(); ++i) {
    if (kinds[i] == "frame" || kinds[i] == "joint") frames.push_back(paths[i]);
    if (kinds[i] == "workframe") workframes.emplace_back(bare_name(paths[i]));
  }
  std::ranges::sort(frames);
  JsonWriter out;
  out.begin_object();
  add_names(out, "robots", robots);
  add_names(out, "frames", frames);
  add_names(out, "workframes", workframes);
  add_names(out, "cameras", cameras);
  add_names(out, "sensors", sensors);
  add_names(out, "scripts", files_with(home / "scripts", ".spt", false));
  add_names(out, "views", files_with(home / "scripts", ".vws", false));
  return out.end_object().take();
}

}  // namespace cellmirror::app
