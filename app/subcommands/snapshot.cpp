// cellmirror snapshot: a picture, or a film, of the running gateway; or a picture of a cell file.
#include <fmt/format.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/console/load_progress.hpp"
#include "app/console/put.hpp"
#include "app/pictures/cell_snapshot.hpp"
#include "app/pictures/film.hpp"
#include "app/pictures/picture_file.hpp"
#include "app/pictures/snapshot_request.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/instance.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::seconds kSnapshotTimeout{20};

struct SnapshotOptions {
  SnapshotRequest wanted;
  std::string cell;
  std::string instance{kDefaultInstance};
  std::string output;
  std::string size;
  std::optional<int> quality;
  std::string film;
  double seconds = 5;
  double rate_hz = 10;
  bool json = false;
};

// "640x480".
std::optional<std::pair<int, int>> size_of(const std::string& text) {
  int width = 0;
  int height = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  if (first.ec != std::errc{} || first.ptr == end || (*first.ptr != 'x' && *first.ptr != 'X')) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, height);
  if (second.ec != std::errc{} || second.ptr != end) return std::nullopt;
  return std::pair{width, height};
}

std::string wrong_size(const std::string& text) {
  const auto size = size_of(text);
  const auto good = [](int edge) { return edge >= kSmallestImageEdge && edge <= kLargestImageEdge; };
  if (size && good(size->first) && good(size->second)) return {};
  return fmt::format("'{}' is no size of a picture: e.g. 1280x720, edges of {} to {} pixels", text, kSmallestImageEdge,
                     kLargestImageEdge);
}

volatile std::sig_atomic_t film_is_over = 0;

Result<SnapshotAnswer> ask(const SnapshotOptions& options) {
  const auto text = control_request(options.instance, control_request_line(question(options.wanted)), kSnapshotTimeout);
  if (!text) return std::unexpected(text.error());
  return snapshot_answer(*text);
}

// `more`: one more member of the document.
template <class Value>
int report(const SnapshotOptions& options, const SnapshotAnswer& picture, const char* more, const Value& value) {
  if (options.json) {
    JsonWriter document;
    document.begin_object()
        .member("file", options.output)
        .member("format", picture.format == ImageFormat::png ? "png" : "jpeg")
        .member("width", picture.width)
        .member("height", picture.height)
        .member("bytes", picture.bytes.size())
        .fixed_member("posture_age_s", picture.posture_age_s, 6)
        .member(more, value)
        .end_object();
    put(stdout, "{}\n", document.take());
  } else {
    put(stdout, "{}: {} x {}, {} bytes\n", options.output, picture.width, picture.height, picture.bytes.size());
  }
  return kExitDone;
}

int of_cell(const SnapshotOptions& options) {
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded;
  {
    ProgressLine line("files loaded");
    loaded = load_cell(options.cell, diagnostics, load_progress(line));
  }
  std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
  if (!loaded) return kExitRefused;
  auto picture = cell_snapshot(*loaded, options.wanted);
  if (!picture) return refuse(picture.error().text());
  const auto written = write_picture_file(options.output, picture->image.bytes);
  if (!written) return refuse(written.error().text());
  const EncodedImage& image = picture->image;
  return report(options, {image.format, image.width, image.height, 1, 0.0, std::move(picture->image.bytes)}, "renderer",
                picture->renderer);
}

int of_gateway(const SnapshotOptions& options) {
  const auto picture = ask(options);
  if (!picture) return refuse(picture.error().text());
  const auto written = write_picture_file(options.output, picture->bytes);
  if (!written) return refuse(written.error().text());
  return report(options, *picture, "sequence", picture->sequence);
}

int film(const SnapshotOptions& options) {
  // Before anything is made: is there a gateway, and does it take pictures?
  if (const auto first = ask(options); !first) return refuse(first.error().text());
  std::string note;
  auto sink = make_film_sink(options.film, options.rate_hz, note);
  if (!sink) return refuse(sink.error().text());
  if (!note.empty()) put(stderr, "cellmirror: {}\n", note);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, [](int) { film_is_over = 1; });
  const auto totals = take_film([&] { return ask(options); }, options.seconds, options.rate_hz, **sink,
                                [] { return film_is_over != 0; });
  if (!totals) return refuse(totals.error().text());
  const auto finished = (*sink)->finish();
  if (!finished) return refuse(finished.error().text());
  if (options.json) {
    JsonWriter document;
    document.begin_object()
        .member("film", options.film)
        .member("frames", totals->frames)
        .member("repeated", totals->repeated)
        .member("rate_hz", options.rate_hz)
        .fixed_member("longest_s", totals->longest_s, 3)
        .end_object();
    put(stdout, "{}\n", document.take());
  } else {
    put(stdout, "{}\n", *finished);
    if (totals->repeated > 0) {
      put(stdout, "{} of them were late and show the picture before again; try a smaller --size or --rate\n",
          totals->repeated);
    }
  }
  return kExitDone;
}

// Empty: nothing is wrong.
std::string wrong_usage(const SnapshotOptions& options) {
  if (options.output.empty() == options.film.empty()) return "name a picture with -o FILE, or a film with --film";
  if (!options.output.empty() && !picture_format(options.output))
    return fmt::format("'{}': pictures are .png, .jpg or .jpeg", options.output);
  if (!options.film.empty() && !options.cell.empty()) return "a film is taken of a running gateway, not of a cell file";
  return {};
}

int snapshot(SnapshotOptions options) {
  if (!options.size.empty()) {
    const auto size = size_of(options.size);
    options.wanted.width = size->first;
    options.wanted.height = size->second;
  }
  if (options.quality) options.wanted.quality = *options.quality;
  options.wanted.format = options.film.empty() ? *picture_format(options.output) : ImageFormat::jpeg;
  if (!options.film.empty()) return film(options);
  return options.cell.empty() ? of_gateway(options) : of_cell(options);
}

}  // namespace

void add_snapshot(cli::Command program, Action& action) {
  auto options = std::make_shared<SnapshotOptions>();
  cli::Command sub =
      program.subcommand("snapshot", "Take a picture or a film of the running gateway, or of a cell file");
  sub.option("-o,--output", options->output, "the picture: FILE.png or FILE.jpg");
  auto cell =
      sub.option("--cell", options->cell, "of this cell file, or folder of a cell, at its start; needs no gateway");
  sub.option("--instance", options->instance, "name of the gateway").show_default().excludes(cell);
  auto view = sub.option("--view", options->wanted.view, "view 0 to 6; else the display as SCRIPT has set it");
  view.between(0, 6);
  sub.option("--camera", options->wanted.camera, "what this camera sees").excludes(view);
  sub.option("--size", options->size, "of the picture, in pixels; else as the cell file says").check(wrong_size, "WxH");
  sub.option("--quality", options->quality, "of JPEG, 1 to 100 (90)").between(1, 100);
  sub.option("--film", options->film, "film: F.mp4 (by ffmpeg), F.mjpeg, or a folder of frames");
  sub.option("--seconds", options->seconds, "length of the film").between(0.1, 86'400.0).show_default();
  sub.option("--rate", options->rate_hz, "pictures a second of the film").between(0.1, 60.0).show_default();
  sub.flag("--json", options->json, "one JSON document (docs/pictures.md)");
  sub.footer(
      "Example: cellmirror snapshot --view 0 --size 1280x720 -o cell.png\n"
      "         cellmirror snapshot --cell config/cells/transfer_cell/cell.toml -o cell.png\n"
      "         cellmirror snapshot --film drive.mp4 --seconds 10 --rate 20");
  sub.when_named([options, &action] { action = [options] { return snapshot(*options); }; },
                 [options] { return wrong_usage(*options); });
}

}  // namespace cellmirror::app
