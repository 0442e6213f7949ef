// cellmirror range: what the ultrasonic sensors of a cell read, for postures from a file.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "app/console/progress_line.hpp"
#include "app/proximity/proximity_cell.hpp"
#include "app/proximity/range_report.hpp"
#include "app/proximity/range_run.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"

namespace cellmirror::app {

namespace {

struct RangeOptions {
  std::string cell;
  std::string postures;
  std::string plot;
  bool json = false;
};

int print(const RangeOptions& options, const ProximityCell& cell, Postures& postures) {
  const RangeHeading heading{cell.loaded.name, postures.count()};
  std::optional<RangeJson> json_report;
  std::optional<RangeText> text_report;
  if (options.json) {
    json_report.emplace(heading, *cell.compiled, stdout);
  } else {
    text_report.emplace(heading, *cell.compiled, stdout);
  }
  Result<RangeTotals> totals;
  {
    ProgressLine line("frames");
    totals = run_range(cell.compiled, std::make_shared<geometry::SolidLibrary>(), postures,
                       [&](std::uint64_t frame, std::span<const RangeReading> readings) {
                         if (json_report) json_report->frame(readings);
                         if (text_report) text_report->frame(frame, readings);
                         line.update(frame, heading.frames);
                       });
  }
  if (!totals) return refuse(totals.error().text());
  if (json_report) json_report->end(*totals);
  if (text_report) text_report->end(*totals);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    return refuse(std::string("standard output cannot be written: ") + std::strerror(errno));
  if (options.plot.empty()) return kExitDone;
  const auto drawn = plot::write_png(figure(heading, *cell.compiled, *totals), options.plot);
  return drawn ? kExitDone : refuse(drawn.error().text());
}

int range(const RangeOptions& options) {
  auto cell = load_proximity_cell(options.cell);
  auto postures = cell ? open_postures(options.postures, *cell) : nullptr;
  if (!postures) return kExitRefused;
  return print(options, *cell, *postures);
}

}  // namespace

void add_range(cli::Command program, Action& action) {
  auto options = std::make_shared<RangeOptions>();
  cli::Command sub = program.subcommand("range", "Read the ultrasonic sensors of a cell");
  sub.option("--cell", options->cell, "the cell file or its folder").required();
  sub.option("--poses", options->postures,
             "CSV of postures: header robot.joint,...; rad or m; default: the start posture");
  sub.option("--plot", options->plot, "draw the readings over the frames: a PNG file");
  sub.flag("--json", options->json, "one JSON document (docs/ranging.md)");
  sub.footer(
      "All sensors of the cell are read, also those that are not active.\n"
      "Example: cellmirror range --cell config/cells/transfer_cell/cell.toml");
  sub.when_named([options, &action] { action = [options] { return range(*options); }; });
}

}  // namespace cellmirror::app
