// cellmirror check FILE...: all diagnostics of cell files, components, SCRIPT and bus descriptions.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/gateway/hosts.hpp"
#include "app/gateway/robot_streams.hpp"
#include "app/subcommands/check_bus_files.hpp"
#include "app/subcommands/load_progress.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/cell_file.hpp"
#include "config/command_line/command_line.hpp"
#include "config/view_file.hpp"
#include "rt_core/base/home.hpp"
#include "scripts/lang/reader.hpp"

namespace cellmirror::app {

namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::string cell;      // for the names in SCRIPT files
  std::string language;  // of robot programs
  bool json = false;
};

// A text beyond this is no SCRIPT file; the reader has its own, smaller limit and says so.
constexpr std::size_t kLargestText = std::size_t{256} << 20;

void check_script_file(const std::filesystem::path& path, const NameDirectory* names, Diagnostics& diagnostics) {
  const auto text = read_text_file(path, kLargestText);
  if (!text) {
    diagnostics.error({path.string()}, text.error().what, text.error().remedy);
    return;
  }
  script::check_script(*text, path.string(), names, diagnostics);
}

// A cell file with everything it names: components, and the bus descriptions of its streams.
void check_cell_file(const std::filesystem::path& path, Diagnostics& diagnostics, const LoadProgress& progress) {
  const std::optional<LoadedCell> cell = load_cell(path, diagnostics, progress);
  if (!cell) return;
  const SystemClock clock;
  for (const RobotStream& stream : cell->streams) {
    const auto made = make_robot_stream(stream.config, clock, 0);
    if (!made)
      diagnostics.error({path.string()}, "stream of " + stream.robot + ": " + made.error().what, made.error().remedy);
  }
}

// Cameras are looked up where a cell is given.
void check_view_file(const std::filesystem::path& path, const NameDirectory* names, Diagnostics& diagnostics) {
  const auto views = read_views(path, path.string(), diagnostics);
  if (!views || names == nullptr) return;
  for (const StoredView& view : views->views) {
    if (view.camera.empty() || names->knows(NameKind::camera, view.camera)) continue;
    const Error why = names->explain(NameKind::camera, view.camera);
    diagnostics.error(view.camera_place, why.what, why.remedy);
  }
}

void check_one(const std::filesystem::path& path, const NameDirectory* names, Diagnostics& diagnostics) {
  ProgressLine line("files loaded");
  if (path.extension() == ".spt") return check_script_file(path, names, diagnostics);
  if (path.extension() == ".toml") return check_cell_file(path, diagnostics, load_progress(line));
  if (path.extension() == kViewExtension) return check_view_file(path, names, diagnostics);
  if (is_bus_file(path)) return check_bus_file(path, diagnostics);
  if (is_checkable(path)) return check_file(path, diagnostics, load_progress(line));
  diagnostics.error({path.string()}, "files of this kind cannot be checked",
                    "known: .spt .toml .mpc .urdf .vws .dbc .eds .dcf");
}

void print_json(const Diagnostics& diagnostics) {
  nlohmann::json list = nlohmann::json::array();
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    list.push_back({{"severity", severity_word(diagnostic.severity)},
                    {"file", diagnostic.place.file},
                    {"line", diagnostic.place.line},
                    {"column", diagnostic.place.column},
                    {"message", diagnostic.message},
                    {"remedy", diagnostic.remedy}});
  }
  const nlohmann::json document = {
      {"errors", diagnostics.errors()}, {"warnings", diagnostics.warnings()}, {"diagnostics", std::move(list)}};
  std::printf("%s\n", document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

int check(const CheckOptions& options) {
  if (!options.language.empty()) return refuse("robot programs (--language) are not available yet");
  Diagnostics diagnostics;
  std::optional<LoadedCell> cell;
  std::optional<CellNames> names;
  if (!options.cell.empty()) {
    ProgressLine line("files loaded");
    cell = load_cell(options.cell, diagnostics, load_progress(line));
    if (cell) names.emplace(cell->cell);
  }
  for (const std::string& file : options.files) check_one(file, names ? &*names : nullptr, diagnostics);
  if (options.json) {
    print_json(diagnostics);
  } else {
    std::fputs(diagnostics.text().c_str(), stderr);
    if (diagnostics.ok())
      std::printf("%zu files, no errors, %zu warnings\n", options.files.size(), diagnostics.warnings());
  }
  return diagnostics.ok() ? kExitDone : kExitRefused;
}

}  // namespace

void add_check(cli::Command program, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  cli::Command sub = program.subcommand("check", "Check files and print everything that is wrong with them");
  sub.option("files", options->files, ".spt .toml .mpc .urdf .vws .dbc .eds .dcf").required();
  sub.option("--cell", options->cell, "check the names in SCRIPT and view files against this cell");
  sub.option("--language", options->language, "language of robot programs (not available yet)")
      .one_of({"irdata", "srcl", "jet_boom", "jet_tarm"});
  sub.flag("--json", options->json, "one JSON document: errors, warnings, diagnostics");
  sub.footer("Example: cellmirror check scripts/demo.spt --cell cell.toml");
  sub.when_named([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace cellmirror::app
