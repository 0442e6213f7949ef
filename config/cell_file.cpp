#include "config/cell_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <utility>

#include "config/cell_reader.hpp"
#include "config/component_files.hpp"
#include "config/hyper_file.hpp"
#include "config/layout_file.hpp"
#include "config/msh/msh_file.hpp"
#include "config/node_numbers.hpp"
#include "config/parse.hpp"
#include "config/sparkplug_names.hpp"
#include "config/tissue_object.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

// Reports every file read from now on to `progress`, until it is destroyed. Scans all component files to count them and
// their meshes, which takes little time compared with the meshes.
class ProgressOfFiles {
 public:
  ProgressOfFiles(const std::string& file, std::string_view text, const HomeFiles& files, const LoadProgress& progress)
      : meshes_(files.meshes()) {
    if (!progress) return;
    meshes_.count_only(true);
    CellReader reader(file, files);
    Diagnostics ignored;
    std::size_t total = 0;
    if (reader.read(text)) {
      ComponentFiles components(files);
      components.load(reader.root, ignored);
      total = components.files().size() + meshes_.counted();
    }
    meshes_.count_only(false);
    meshes_.set_progress([&progress, total, done = std::size_t{0}](const fs::path& path) mutable {
      progress(done, std::max(total, done + 1), path.filename().string());
      ++done;
    });
  }
  ~ProgressOfFiles() { meshes_.set_progress({}); }
  ProgressOfFiles(const ProgressOfFiles&) = delete;
  ProgressOfFiles& operator=(const ProgressOfFiles&) = delete;

 private:
  MeshLibrary& meshes_;
};

// Errors in the cell file itself are added to its other diagnostics.
void check_streams(const CellReader& reader, const std::string& file, const StreamCheck& check, Diagnostics& of_cell,
                   Diagnostics& of_others) {
  if (!check) return;
  for (const RobotStream& stream : reader.streams) {
    Diagnostics found;
    check(stream, found);
    for (const Diagnostic& diagnostic : found.all())
      (diagnostic.place.file == file ? of_cell : of_others).add(diagnostic);
  }
}

}  // namespace

fs::path cell_file_of(const fs::path& path) {
  std::error_code unreadable;  // reading it says why
  return fs::is_directory(path, unreadable) ? path / "cell.toml" : path;
}

std::optional<LoadedCell> load_cell(const fs::path& given, Diagnostics& diagnostics, const LoadProgress& progress,
                                    const StreamCheck& check_stream) {
  const fs::path path = cell_file_of(given);
  const Place whole_file{path.string(), 0, 0};
  const auto refuse = [&](const Error& error) {
    diagnostics.error(whole_file, error.what, error.remedy);
    return std::nullopt;
  };
  std::error_code unreadable;
  if (path != given && !fs::exists(path, unreadable)) {
    diagnostics.error({given.string(), 0, 0}, "there is no cell.toml in this folder",
                      "name a cell file, or the folder of a cell");
    return std::nullopt;
  }
  const auto text = read_text_file(path, kLargestText);
  if (!text) return refuse(text.error());
  auto home = KismetHome::of_cell(path);
  if (!home) return refuse(home.error());
  const HomeFiles files(*home);
  const ProgressOfFiles telling(path.string(), *text, files, progress);
  CellReader reader(path.string(), files);
  const bool readable = reader.read(*text);
  auto source = std::make_shared<ComponentFiles>(files);
  Diagnostics of_components;
  Diagnostics of_streams;
  Diagnostics of_bus_files;
  Diagnostics of_tissue;
  std::optional<Cell> cell;
  if (readable) {
    source->load(reader.root, of_components);
    reader.read_streams(source->robots(), true);
    check_node_numbers(reader.streams, reader.io.nodes, reader.findings);
    reader.read_haptics(source->robots(), true);
    reader.read_controllers(source->robots(), true);
    check_streams(reader, path.string(), check_stream, of_streams, of_bus_files);
    reader.tissue.read_files(files, of_tissue);
    // With earlier errors Cell::build() returns no cell, but continues to check.
    Diagnostics building = of_components;
    building.take(reader.findings);
    const std::size_t before = building.all().size();
    cell = Cell::build(std::make_shared<const Component>(reader.root), source, building);
    for (std::size_t i = before; i < building.all().size(); ++i) reader.findings.add(building.all()[i]);
  }
  Diagnostics of_layout;
  DisplayLayout layout;
  if (reader.layout_file) {
    if (auto stored = read_layout(*reader.layout_file, reader.layout_file->string(), of_layout))
      layout = *std::move(stored);
  }
  collision::Settings collision;
  if (cell) collision = reader.collision.settings(*cell, reader.findings);
  if (cell) reader.io.complete(*cell, reader.findings);
  if (cell) check_sparkplug_names(*cell, reader.mqtt, whole_file, reader.findings);
  TissueSetup tissue;
  if (cell) tissue = reader.tissue.setup(*cell, reader.findings);
  reader.findings.take(of_streams);
  if (!reader.findings.ok() || !of_layout.ok() || !of_bus_files.ok() || !of_tissue.ok()) cell.reset();
  take_sorted(diagnostics, reader.findings);
  diagnostics.take(of_components);
  diagnostics.take(of_bus_files);
  diagnostics.take(of_layout);
  diagnostics.take(of_tissue);
  source->release();
  if (!cell) return std::nullopt;
  return LoadedCell{std::move(reader.name),
                    std::move(reader.description),
                    path,
                    std::move(*home),
                    reader.gravity_m_s2,
                    reader.loop,
                    std::move(reader.streams),
                    std::move(reader.haptics),
                    std::move(reader.io.nodes),
                    std::move(reader.io.barriers),
                    std::move(reader.controllers),
                    reader.foot_switches,
                    reader.dds,
                    reader.ros,
                    reader.dds_network,
                    reader.mqtt,
                    reader.queues,
                    reader.web,
                    std::move(reader.record),
                    reader.pictures,
                    std::move(collision),
                    std::move(tissue),
                    std::move(reader.views),
                    std::move(layout),
                    std::move(reader.startup_script),
                    files.found(),
                    std::move(*cell)};
}

namespace {

// The cell folder of a component: $kis_home, else the nearest folder above it with a cell.toml, else its own folder.
Result<KismetHome> home_of_component(const fs::path& path) {
  const char* from_environment = std::getenv("kis_home");
  if (from_environment != nullptr && *from_environment != '\0') return KismetHome::open(from_environment);
  std::error_code error;
  const fs::path full = fs::weakly_canonical(path, error);
  if (error) return fail(fmt::format("{} cannot be opened: {}", path.string(), error.message()));
  constexpr int kHighest = 32;
  fs::path folder = full.parent_path();
  for (int i = 0; i < kHighest && folder.has_relative_path(); ++i) {
    if (fs::exists(folder / "cell.toml", error)) return KismetHome::open(folder);
    folder = folder.parent_path();
  }
  return KismetHome::open(full.parent_path());
}

}  // namespace

bool is_checkable(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  static constexpr std::array<std::string_view, 6> kKinds{".toml", ".mpc", ".urdf", ".mpo", ".hyper", ".msh"};
  return std::ranges::find(kKinds, extension) != kKinds.end();
}

void check_file(const fs::path& path, Diagnostics& diagnostics, const LoadProgress& progress) {
  if (!is_checkable(path)) {
    diagnostics.error({path.string(), 0, 0}, "this kind of file cannot be checked here",
                      "cells are .toml, components .mpc or .urdf, deformable objects .mpo, .hyper and .msh");
    return;
  }
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".toml") return static_cast<void>(load_cell(path, diagnostics, progress));
  if (extension == kHyperExtension) return static_cast<void>(read_hyper(path, nullptr, diagnostics));
  if (extension == ".msh") return static_cast<void>(msh::read_msh(path, 1.0, diagnostics));
  const auto home = home_of_component(path);
  if (!home) {
    diagnostics.error({path.string(), 0, 0}, home.error().what, home.error().remedy);
    return;
  }
  const HomeFiles files(*home);
  if (progress) {
    files.meshes().set_progress([&progress, done = std::size_t{0}](const fs::path& file) mutable {
      progress(done, done + 1, file.filename().string());
      ++done;
    });
  }
  if (extension == kObjectExtension) return static_cast<void>(read_object(path, files, diagnostics));
  const auto component = read_component_file(path, files, diagnostics);
  if (!component) return;
  ComponentFiles others(files);
  others.load(*component, diagnostics);
}

}  // namespace cellmirror
