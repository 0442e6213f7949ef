// cellmirror collide: what touches and what is near in a cell, for postures from a file.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "app/console/progress_line.hpp"
#include "app/proximity/collide_report.hpp"
#include "app/proximity/collide_run.hpp"
#include "app/proximity/pairs_report.hpp"
#include "app/proximity/proximity_cell.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

struct CollideOptions {
  std::string cell;
  std::string postures;
  std::string warning;
  bool pairs = false;
  std::string plot;
  bool json = false;
};

constexpr double kLongestWarning = 1e3;  // m

std::string wrong_warning(const std::string& text) {
  const auto value = parse_number(text);
  if (value && *value >= 0.0 && *value <= kLongestWarning) return {};
  return fmt::format("{} is no distance from 0 to {:g} m", printable(text), kLongestWarning);
}

// All that was written has to have arrived: a full disk is a failure.
bool flushed(const std::string& what) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  refuse(what + " cannot be written: " + std::strerror(errno));
  return false;
}

int report_pairs(const CollideOptions& options, const std::string& cell, const collision::PairTable& pairs) {
  if (options.json) {
    print_pairs_json(cell, pairs, stdout);
  } else {
    print_pairs(cell, pairs, stdout);
  }
  return flushed("standard output") ? kExitDone : kExitRefused;
}

int report_frames(const CollideOptions& options, const CollideInput& input, const std::string& cell,
                  Postures& postures) {
  const CollideHeading heading{cell, input.settings.warning_distance_m, postures.count()};
  std::optional<CollideJson> json;
  std::optional<CollideText> text;
  if (options.json) {
    json.emplace(heading, *input.pairs, stdout);
  } else {
    text.emplace(heading, *input.pairs, stdout);
  }
  Result<CollideTotals> totals;
  {
    ProgressLine line("frames");
    totals = run_collide(input, postures, [&](std::uint64_t frame, const ProximityState& state) {
      if (json) json->frame(state);
      if (text) text->frame(frame, state);
      line.update(frame, heading.frames);
    });
  }
  if (!totals) return refuse(totals.error().text());
  if (json) json->end(*totals);
  if (text) text->end(*totals);
  if (!flushed("standard output")) return kExitRefused;
  if (options.plot.empty()) return kExitDone;
  const auto drawn = plot::write_png(figure(heading, *totals), options.plot);
  return drawn ? kExitDone : refuse(drawn.error().text());
}

int collide(const CollideOptions& options) {
  auto cell = load_proximity_cell(options.cell);
  auto postures = cell ? open_postures(options.postures, *cell) : nullptr;
  if (!postures) return kExitRefused;
  CollideInput input;
  input.cell = cell->compiled;
  input.settings = cell->loaded.collision;
  input.settings.active = true;  // asked for by name
  if (!options.warning.empty()) input.settings.warning_distance_m = *parse_number(options.warning);
  collision::PairDerivation derivation(std::make_shared<geometry::SolidLibrary>());
  input.pairs = derivation.derive(*input.cell, input.settings, postures->beyond());
  if (options.pairs) return report_pairs(options, cell->loaded.name, *input.pairs);
  return report_frames(options, input, cell->loaded.name, *postures);
}

}  // namespace

void add_collide(cli::Command program, Action& action) {
  auto options = std::make_shared<CollideOptions>();
  cli::Command sub = program.subcommand("collide", "Find what touches and what is near in a cell");
  sub.option("--cell", options->cell, "the cell file or its folder").required();
  auto postures = sub.option("--poses", options->postures,
                             "CSV of postures: header robot.joint,...; rad or m; default: the start posture");
  auto warning = sub.option("--warning", options->warning, "warning distance in m, instead of the cell file's")
                     .check(wrong_warning, "M");
  auto plot = sub.option("--plot", options->plot, "draw the smallest distance over the frames: a PNG file");
  sub.flag("--pairs", options->pairs, "only list the pairs: which are tested, and why others are not")
      .excludes(postures)
      .excludes(warning)
      .excludes(plot);
  sub.flag("--json", options->json, "one JSON document (docs/collisions.md)");
  sub.footer(
      "Collisions are results, not failures: the exit status is 0.\n"
      "Example: cellmirror collide --cell config/cells/transfer_cell/cell.toml --poses day.csv --plot day.png");
  sub.when_named([options, &action] { action = [options] { return collide(*options); }; });
}

}  // namespace cellmirror::app
