// cellmirror recording: what is in a recorded file, whether it is whole, its repair, and its messages as tables.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/console/put.hpp"
#include "app/plot/figure.hpp"
#include "app/recording/recording_export.hpp"
#include "app/recording/recording_plot.hpp"
#include "app/recording/recording_report.hpp"
#include "app/subcommands/reading.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/record/recover.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

struct RecordingOptions {
  std::string file;
  std::string output;
  std::string compression = "zstd";
  std::string topic;
  std::string fields;
  bool joints = false;
  bool candump = false;
  double from_s = 0;
  std::optional<double> to_s;
  bool json = false;
  std::optional<double> decompressed_gb;
};

int printed(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? kExitDone : refuse("standard output cannot be written");
}

int recording_info(const RecordingOptions& options) {
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  ReadingWatch watch;
  mcap::Limits limits = watch.watched(limits_of(options.decompressed_gb));
  limits.leave_out_beyond = true;
  const auto reader = mcap::Reader::open(**source, limits);
  watch.end();
  if (!reader) return refuse(options.file + ": " + reader.error().text());
  const std::uint64_t bytes = (*source)->size();
  return printed(options.json ? recording_info_json(options.file, bytes, *reader)
                              : recording_info_text(options.file, bytes, *reader));
}

int recording_check(const RecordingOptions& options) {
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  ReadingWatch watch;
  const auto check = check_recording(**source, watch.watched(limits_of(options.decompressed_gb)));
  watch.end();
  if (!check) return refuse(options.file + ": " + check.error().text());
  if (const int status = printed(options.json ? recording_check_json(options.file, *check)
                                              : recording_check_text(options.file, *check));
      status != kExitDone)
    return status;
  if (check->whole()) return kExitDone;
  return refuse(options.file + " is not whole; repair it with: " + recover_command(options.file));
}

int recording_recover(const RecordingOptions& options) {
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  auto sink = mcap::FileSink::create(options.output);
  if (!sink) return refuse(sink.error().text());
  ReadingWatch watch;
  const auto report = mcap::recover(**source, **sink, *mcap::compression_of(options.compression),
                                    watch.watched(limits_of(options.decompressed_gb)));
  watch.end();
  if (!report) {
    std::remove(options.output.c_str());
    return refuse(options.file + ": " + report.error().text());
  }
  if (auto synced = (*sink)->sync(); !synced) return refuse(synced.error().text());
  if (options.json) {
    JsonWriter out;
    out.begin_object()
        .member("file", options.output)
        .member("messages", report->written.messages)
        .member("chunks", report->written.chunks)
        .member("attachments", report->written.attachments)
        .member("chunks_lost", report->chunks_lost)
        .member("faults", report->faults.count())
        .member("was_whole", report->was_whole)
        .end_object();
    return printed(out.take() + "\n");
  }
  std::string out;
  for (const mcap::Fault& fault : report->faults.first())
    out += fmt::format("at byte {}: {}\n", fault.offset, fault.what);
  out += fmt::format("{}: {} messages and {} attachments{}", options.output, report->written.messages,
                     report->written.attachments,
                     report->was_whole ? std::string("; nothing was to be repaired") : std::string());
  if (report->chunks_lost > 0) out += fmt::format("; {} chunks are lost", report->chunks_lost);
  return printed(out + "\n");
}

// Log times `from_s` and `to_s` after the first.
mcap::Filter filter_of(const RecordingOptions& options, const mcap::Reader& reader) {
  const auto at = [&](double s) {
    const double ns = std::min(1e9 * s, 9e18);
    return reader.statistics().start_time + static_cast<std::uint64_t>(std::llround(ns));
  };
  mcap::Filter filter;
  filter.from = options.from_s > 0 ? at(options.from_s) : 0;
  if (options.to_s) filter.to = at(*options.to_s);
  return filter;
}

int recording_export(const RecordingOptions& options) {
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  ReadingWatch watch(!options.output.empty() || ::isatty(STDOUT_FILENO) == 0);
  auto reader = mcap::Reader::open(**source, watch.watched(limits_of(options.decompressed_gb)));
  if (!reader) return refuse(options.file + ": " + reader.error().text());
  const mcap::Filter filter = filter_of(options, *reader);
  std::FILE* out = stdout;
  if (!options.output.empty()) {
    out = std::fopen(options.output.c_str(), "wbx");
    if (out == nullptr)
      return refuse(fmt::format("{} cannot be created: {}; give another name", options.output, std::strerror(errno)));
  }
  const auto totals = options.candump  ? export_candump(*reader, options.topic, filter, out)
                      : options.joints ? export_postures(*reader, options.topic, filter, out)
                      : options.json   ? export_json(*reader, options.topic, filter, out)
                                       : export_csv(*reader, options.topic, filter, out);
  watch.end();
  bool good = std::fflush(out) == 0 && std::ferror(out) == 0;
  if (out != stdout) good = std::fclose(out) == 0 && good;
  if (!totals) {
    if (out != stdout) std::remove(options.output.c_str());
    return refuse(options.file + ": " + totals.error().text());
  }
  if (!good) return refuse((options.output.empty() ? "standard output" : options.output) + " cannot be written");
  if (totals->left_out > 0)
    put(stderr, "cellmirror: {} messages were left out: {}\n", totals->left_out, totals->first_problem);
  if (!options.output.empty())
    put(stdout, "{}: {} rows of {} columns\n", options.output, totals->messages, totals->columns);
  return kExitDone;
}

std::vector<std::string> divided(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    if (!trimmed(one).empty()) out.emplace_back(trimmed(one));
  }
  return out;
}

int recording_plot(const RecordingOptions& options) {
  const auto source = mcap::FileSource::open(options.file);
  if (!source) return refuse(source.error().text());
  ReadingWatch watch;
  auto reader = mcap::Reader::open(**source, watch.watched(limits_of(options.decompressed_gb)));
  if (!reader) return refuse(options.file + ": " + reader.error().text());
  const auto figure = recording_figure(*reader, options.topic, divided(options.fields), filter_of(options, *reader));
  watch.end();
  if (!figure) return refuse(options.file + ": " + figure.error().text());
  if (const auto written = plot::write_png(*figure, options.output); !written) return refuse(written.error().text());
  std::size_t lines = 0;
  for (const plot::Panel& panel : figure->panels) lines += panel.lines.size();
  put(stdout, "{}: {}, {}\n", options.output, figure->subtitle, number_of(lines, "line"));
  return kExitDone;
}

void add_file(cli::Command& command, RecordingOptions& options) {
  command.option("file", options.file, "the recording, an .mcap file").required();
  add_decompressed_limit(command, options.decompressed_gb);
}

}  // namespace

void add_recording(cli::Command program, Action& action) {
  auto options = std::make_shared<RecordingOptions>();
  cli::Command sub = program.subcommand("recording", "Look into recorded files, repair them, make tables of them");
  sub.require_subcommand();
  cli::Command info = sub.subcommand("info", "Topics with counts, rates and drops");
  add_file(info, *options);
  info.flag("--json", options->json, "one JSON document (docs/recording.md)");
  info.footer("Example: cellmirror recording info night.mcap");
  info.when_named([options, &action] { action = [options] { return recording_info(*options); }; });
  cli::Command check = sub.subcommand("check", "Read every byte: lengths, CRCs, summary; 1 where something is wrong");
  add_file(check, *options);
  check.flag("--json", options->json, "one JSON document (docs/recording.md)");
  check.footer("Example: cellmirror recording check night.mcap");
  check.when_named([options, &action] { action = [options] { return recording_check(*options); }; });
  cli::Command recover = sub.subcommand("recover", "Write what is whole of a broken recording into a new file");
  add_file(recover, *options);
  recover.option("-o,--output", options->output, "the new file").required();
  recover.option("--compression", options->compression, "of the new file")
      .one_of({"zstd", "lz4", "none"})
      .show_default();
  recover.flag("--json", options->json, "one JSON document (docs/recording.md)");
  recover.footer("Example: cellmirror recording recover night.mcap -o night-repaired.mcap");
  recover.when_named([options, &action] { action = [options] { return recording_recover(*options); }; });
  cli::Command exported = sub.subcommand("export", "A topic as CSV or JSON, or joints as a file of postures");
  add_file(exported, *options);
  exported.option("--topic", options->topic, "the topic; with --joints: only that one");
  auto joints = exported.flag("--joints", options->joints, "postures for collide, range and sim_robot");
  auto candump = exported.flag("--candump", options->candump, "recorded CAN frames as a candump log").excludes(joints);
  exported.option("--from", options->from_s, "seconds after the start of the recording").between(0.0, 1e9);
  exported.option("--to", options->to_s, "seconds after the start of the recording").between(0.0, 1e9);
  exported.option("-o,--output", options->output, "a new file; else standard output");
  exported.flag("--json", options->json, "one JSON document (docs/recording.md)").excludes(joints).excludes(candump);
  exported.footer(
      "Example: cellmirror recording export night.mcap --topic /joint_states -o joints.csv\n"
      "         cellmirror recording export night.mcap --joints --from 60 --to 70 -o postures.csv");
  exported.when_named([options, &action] { action = [options] { return recording_export(*options); }; },
                      [options] {
                        return options->topic.empty() && !options->joints && !options->candump
                                   ? std::string("name --topic T, or --joints, or --candump")
                                   : std::string();
                      });
  cli::Command plotted = sub.subcommand("plot", "Values of a topic over time, as a picture");
  add_file(plotted, *options);
  plotted.option("--topic", options->topic, "the topic").required();
  plotted
      .option("--fields", options->fields,
              "a panel for each, separated by commas: a value such as nearest_m, or all below a name such as position; "
              "joints: position[ROBOT]")
      .required();
  plotted.option("--from", options->from_s, "seconds after the start of the recording").between(0.0, 1e9);
  plotted.option("--to", options->to_s, "seconds after the start of the recording").between(0.0, 1e9);
  plotted.option("-o,--output", options->output, "the picture, a .png file; an existing one is replaced").required();
  plotted.footer(
      "Example: cellmirror recording plot night.mcap --topic /joint_states --fields position[PUMA] -o joints.png");
  plotted.when_named([options, &action] { action = [options] { return recording_plot(*options); }; });
}

}  // namespace cellmirror::app
