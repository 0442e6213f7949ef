// cellmirror volume: voxel volumes off line.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/subcommands/subcommand.hpp"
#include "app/volume_info/volume_report.hpp"
#include "config/command_line/command_line.hpp"
#include "config/volume/nrrd_file.hpp"
#include "config/volume_file.hpp"

namespace cellmirror::app {

namespace {

struct VolumeOptions {
  std::string source;
  std::string series;
  std::string plot;
  std::optional<double> window_middle;
  std::optional<double> window_width;
  std::string into;
  bool json = false;
};

// What is about the source as a whole has its name as place.
void print_findings(const Diagnostics& found, const std::string& source) {
  for (Diagnostic diagnostic : found.all()) {
    if (diagnostic.place.file.empty()) diagnostic.place.file = source;
    std::fprintf(stderr, "%s\n", diagnostic.text().c_str());
  }
}

std::optional<VolumeData> read_source(const VolumeOptions& options, Diagnostics& found) {
  VolumeRequest request;
  request.source = options.source;
  request.series = options.series;
  request.name = std::filesystem::path(options.source).stem().string();
  return read_volume(options.source, request, found);
}

int convert_volume(const VolumeOptions& options) {
  Diagnostics found;
  const auto volume = read_source(options, found);
  print_findings(found, options.source);
  if (!volume) return kExitRefused;
  const auto written = write_nrrd(*volume, options.into);
  return written ? kExitDone : refuse(written.error().text());
}

int volume_info(const VolumeOptions& options) {
  Diagnostics found;
  const auto volume = read_source(options, found);
  if (!volume || !options.json) print_findings(found, options.source);
  if (!volume) return kExitRefused;
  const VolumeSummary summary = summarise(volume->grid);
  const std::string text =
      options.json ? volume_json(options.source, *volume, summary, found) + "\n" : volume_text(*volume, summary);
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    return refuse("standard output cannot be written");
  if (options.plot.empty()) return kExitDone;
  GreyWindow window = usual_window(volume->grid, summary);
  window.middle = options.window_middle.value_or(window.middle);
  window.width = options.window_width.value_or(window.width);
  const auto drawn = plot::write_png(volume_figure(options.source, *volume, summary, window), options.plot);
  return drawn ? kExitDone : refuse(drawn.error().text());
}

}  // namespace

namespace {

void add_source(cli::Command& command, VolumeOptions& options) {
  command.option("source", options.source, "folder of DICOM slices, .nrrd or .nhdr file, or .toml head of raw data")
      .required();
  command.option("--series", options.series, "UID of the DICOM series, where the folder has several");
}

}  // namespace

void add_volume(cli::Command program, Action& action) {
  auto options = std::make_shared<VolumeOptions>();
  cli::Command sub = program.subcommand("volume", "Voxel volumes");
  sub.require_subcommand();
  cli::Command info = sub.subcommand("info", "What is understood of a volume");
  add_source(info, *options);
  info.option("--plot", options->plot, "three slices through the middle and the histogram: a PNG file");
  info.option("--middle", options->window_middle, "value that is shown in the middle of grey");
  info.option("--width", options->window_width, "values from black to white").positive();
  info.flag("--json", options->json, "one JSON document (docs/cell-files.md)");
  info.footer("Example: cellmirror volume info config/cells/volume_cell/envlib/phantom.nrrd --plot phantom.png");
  info.when_named([options, &action] { action = [options] { return volume_info(*options); }; });
  cli::Command convert = sub.subcommand("convert", "Write a volume as one NRRD file, without what names a patient");
  add_source(convert, *options);
  convert.option("into", options->into, "the .nrrd file to write").required();
  convert.footer("Example: cellmirror volume convert scans/knee envlib/knee.nrrd");
  convert.when_named([options, &action] { action = [options] { return convert_volume(*options); }; });
}

}  // namespace cellmirror::app
