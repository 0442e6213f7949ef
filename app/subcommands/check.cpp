// cellmirror check FILE...: all diagnostics of cell files, components, SCRIPT, bus descriptions and robot programs.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/load_progress.hpp"
#include "app/io/robot_streams.hpp"
#include "app/owner/hosts.hpp"
#include "app/subcommands/check_bus_files.hpp"
#include "app/subcommands/check_commands.hpp"
#include "app/subcommands/check_programs.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/cell_file.hpp"
#include "config/command_line/command_line.hpp"
#include "config/layout_file.hpp"
#include "config/view_file.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/home.hpp"
#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::app {

namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::string cell;      // for the names in SCRIPT files
  std::string language;  // of robot programs; empty: by the extension
  std::string robot;     // of the cell, that the programs are for
  bool json = false;
};

// A cell file with everything it names: components, and the bus descriptions of its streams.
void check_cell_file(const std::filesystem::path& path, Diagnostics& diagnostics, const LoadProgress& progress) {
  static_cast<void>(load_cell(path, diagnostics, progress, check_robot_stream));
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

struct Checked {
  ProgramSurroundings around;
  const program::Language* language = nullptr;  // null: by the extension
};

void check_one(const std::filesystem::path& given, const Checked& against, Diagnostics& diagnostics) {
  const std::filesystem::path path = cell_file_of(given);
  ProgressLine line("files loaded");
  const program::Language* language = against.language;
  if (language != nullptr) check_language(path, *language, diagnostics);
  if (language == nullptr) language = program::language_of_extension(path.extension().string());
  if (language != nullptr) return check_robot_program(path, *language, against.around, diagnostics);
  const auto& [cell, names, robot] = against.around;
  if (path.extension() == ".spt") return check_script_file(path, cell, names, diagnostics);
  if (path.extension() == ".toml") return check_cell_file(path, diagnostics, load_progress(line));
  if (path.extension() == kViewExtension) return check_view_file(path, names, diagnostics);
  if (path.extension() == kLayoutExtension) {
    static_cast<void>(read_layout(path, path.string(), diagnostics));
    return;
  }
  if (is_bus_file(path)) return check_bus_file(path, diagnostics);
  if (is_checkable(path)) return check_file(path, diagnostics, load_progress(line));
  diagnostics.error({path.string()}, "files of this kind cannot be checked",
                    "known: .spt .toml .mpc .urdf .mpo .hyper .msh .vws .lay .dbc .eds .dcf " + program_extensions() +
                        "; --language names that of a robot program");
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

// The cell that names are looked up in, and the robot.
void load_for_check(const CheckOptions& options, std::optional<LoadedCell>& cell, std::optional<CellNames>& names,
                    Checked& against, Diagnostics& diagnostics) {
  ProgressLine line("files loaded");
  cell = load_cell(options.cell, diagnostics, load_progress(line));
  if (!cell) return;
  against.around.cell = &*cell;
  against.around.names = &names.emplace(cell->cell);
  if (options.robot.empty()) return;
  against.around.robot = cell->cell.robot(options.robot);
  if (against.around.robot != nullptr) return;
  const Error why = cell->cell.explain_robot(options.robot);
  diagnostics.error({options.cell}, why.what, why.remedy);
}

int check(const CheckOptions& options) {
  Diagnostics diagnostics;
  std::optional<LoadedCell> cell;
  std::optional<CellNames> names;
  Checked against;
  if (!options.language.empty()) {
    const auto language = program::find_language(options.language);
    if (!language) return refuse(language.error().text());
    against.language = *language;
  }
  if (!options.cell.empty()) load_for_check(options, cell, names, against, diagnostics);
  for (const std::string& file : options.files) check_one(file, against, diagnostics);
  if (options.json) {
    print_json(diagnostics);
  } else {
    std::fputs(diagnostics.text().c_str(), stderr);
    if (diagnostics.ok())
      std::printf("%s, no errors, %s\n", number_of(options.files.size(), "file").c_str(),
                  number_of(diagnostics.warnings(), "warning").c_str());
  }
  return diagnostics.ok() ? kExitDone : kExitRefused;
}

}  // namespace

void add_check(cli::Command program, Action& action) {
  auto options = std::make_shared<CheckOptions>();
  cli::Command sub = program.subcommand("check", "Check files and print everything that is wrong with them");
  sub.option("files", options->files,
             ".spt .toml .mpc .urdf .mpo .hyper .msh .vws .lay .dbc .eds .dcf " + program_extensions() +
                 ", or the folder of a cell")
      .required();
  auto cell = sub.option("--cell", options->cell,
                         "check names, files and ranges in SCRIPT, view files and programs against this cell");
  sub.option("--language", options->language, "the files are robot programs in this language").one_of(language_names());
  sub.option("--robot", options->robot, "check that robot programs fit the joints and limits of this robot of the cell")
      .needs(cell);
  sub.flag("--json", options->json, "one JSON document: errors, warnings, diagnostics");
  sub.footer(
      "Examples: cellmirror check scripts/demo.spt --cell cell.toml\n"
      "          cellmirror check --language irdata --cell cell.toml --robot PUMA_762 programs/weld.ird");
  sub.when_named([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace cellmirror::app
