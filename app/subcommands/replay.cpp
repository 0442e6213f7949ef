// cellmirror replay: runs the recorded inputs of the tick again, or puts the recorded robots into another cell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/console/put.hpp"
#include "app/replay/verification.hpp"
#include "app/subcommands/reading.hpp"
#include "app/subcommands/replay_cells.hpp"
#include "app/subcommands/replay_gateway.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/record/reader.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/playback.hpp"

namespace cellmirror::app {

namespace {

struct ReplayOptions {
  std::string file;
  bool verify = false;
  bool force = false;
  bool json = false;
  std::optional<double> decompressed_gb;
  std::string cell;
  std::string recorded_cell;
  double from_s = 0;
  std::optional<double> to_s;
  ReplayGateway gateway;  // but for what is above
};

// Log times `from_s` and `to_s` after the first.
mcap::Filter filter_of(const ReplayOptions& options, const mcap::Reader& reader) {
  const auto at = [&](double s) {
    return reader.statistics().start_time + static_cast<std::uint64_t>(std::llround(std::min(1e9 * s, 9e18)));
  };
  mcap::Filter filter;
  filter.from = options.from_s > 0 ? at(options.from_s) : 0;
  if (options.to_s) filter.to = at(*options.to_s);
  return filter;
}

int replay(const ReplayOptions& options) {
  if (!options.verify && options.cell.empty()) {
    ReplayGateway gateway = options.gateway;
    gateway.file = options.file;
    gateway.recorded_cell = options.recorded_cell;
    gateway.from_s = options.from_s;
    gateway.to_s = options.to_s;
    gateway.limits = limits_of(options.decompressed_gb);
    return play_recording(gateway);
  }
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  ReadingWatch watch(options.cell.empty());
  auto reader = mcap::Reader::open(**source, watch.watched(limits_of(options.decompressed_gb)));
  if (!reader) return refuse(options.file + ": " + reader.error().text());
  const mcap::Filter filter = filter_of(options, *reader);
  if (!options.cell.empty())
    return compare_cells(*reader, filter,
                         {.other = options.cell, .recorded = options.recorded_cell, .json = options.json});
  if (const std::string other = other_build(*reader); !other.empty() && !options.force)
    return refuse(fmt::format("{}: {}; the last bits may differ for that reason alone: --force compares all the same",
                              options.file, other));
  const SystemClock clock;
  const auto verification = verify(*reader, filter, clock);
  watch.end();
  if (!verification) return refuse(options.file + ": " + verification.error().text());
  put(stdout, "{}{}", options.json ? verification_json(*verification) : verification_text(*verification),
      options.json ? "\n" : "");
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return refuse("standard output cannot be written");
  return verification->equal() ? kExitDone : kExitRefused;
}

}  // namespace

void add_replay(cli::Command program, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  cli::Command sub =
      program.subcommand("replay", "Play a recording as if the gateway ran, compare each tick, or try another cell");
  sub.option("file", options->file, "the recording, an .mcap file").required();
  add_decompressed_limit(sub, options->decompressed_gb);
  auto verifies =
      sub.flag("--verify", options->verify, "compare what each tick published, bit by bit; 1 if one differs");
  sub.flag("--force", options->force, "also where another build or processor has recorded");
  auto other_cell = sub.option("--cell", options->cell, "what touches, and what is near, differently in this cell file")
                        .excludes(verifies);
  sub.option("--recorded-cell", options->recorded_cell, "the cell file that was recorded, if it is elsewhere now")
      .excludes(verifies);
  ReplayGateway& gateway = options->gateway;
  const auto of_playing = [&](cli::Option option) { option.excludes(verifies).excludes(other_cell); };
  sub.option("--from", options->from_s, "seconds after the start of the recording").between(0.0, 1e9);
  sub.option("--to", options->to_s, "seconds after the start of the recording").between(0.0, 1e9);
  of_playing(sub.flag("--page", gateway.page, "with the monitor page; waits at the end for Ctrl-C"));
  of_playing(sub.option("--port", gateway.port, "with the monitor page at this port; otherwise at a free one")
                 .between(0, 65535));
  of_playing(sub.option("--speed", gateway.speed, "times as fast as it was recorded")
                 .between(kSlowestPlayback, kFastestPlayback)
                 .show_default());
  of_playing(sub.flag("--paused", gateway.paused, "paused at the beginning"));
  of_playing(sub.flag("--wait", gateway.wait, "waits at the end for Ctrl-C, without the page too"));
  of_playing(sub.flag("--headless", gateway.headless, "without pictures"));
  of_playing(
      sub.flag("--publish", gateway.publish,
               "SENSOR records and DDS too, with the domain and topics of the cell file: not beside its gateway"));
  of_playing(sub.option("--instance", gateway.instance, "name for cellmirror status and others").show_default());
  sub.flag("--json", options->json, "one JSON document (docs/recording.md); of --verify and --cell");
  sub.footer(
      "Without --verify and --cell it is played: page, pictures and status are as they were then, no device is "
      "opened,\n"
      "and commands that would change the cell are refused. It ends with the recording, or waits there with --page.\n"
      "Collisions in another cell are results, not failures: the exit status is 0.\n"
      "Example: cellmirror replay drive.mcap --page --from 60 --speed 2\n"
      "         cellmirror replay drive.mcap --verify\n"
      "         cellmirror replay drive.mcap --cell longer_tool/cell.toml --from 10 --to 40");
  sub.when_named([options, &action] { action = [options] { return replay(*options); }; });
}

}  // namespace cellmirror::app
