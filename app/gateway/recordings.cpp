#include "app/gateway/recordings.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/recording/build_identity.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "app/report/status_recordings.hpp"
#include "ipc/record/compression.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kLease{10'000'000'000};
constexpr double kLongest_s = 1e7;
constexpr std::size_t kMostTopics = 256;
constexpr double kMostAttachedMegabytes = 1024;

Result<double> number_of_argument(const ControlRequest& request, std::string_view name, double usual, double least,
                                  double most) {
  const auto text = request.argument(name);
  if (!text) return usual;
  const auto value = parse_number(*text);
  if (!value || *value < least || *value > most)
    return fail(fmt::format("{} = {} is no number from {} to {}", name, printable(*text), least, most));
  return *value;
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

std::string dumped(const nlohmann::json& document) {
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

Recordings::Recordings(const Clock& clock) : hub_(clock), texts_(hub_, clock), can_tap_(clock) {
  hub_.set_live(live_);
  set_log_observer(
      [this](LogLevel level, std::string_view kind, std::string_view text) { texts_.log(level, kind, text); });
}

Recordings::~Recordings() {
  set_log_observer({});
  stop();
  hub_.close();
}

void Recordings::begin_ring(const RecordSettings& settings, const Result<std::filesystem::path>& place) {
  settings_ = settings;
  if (!settings.present) return;
  if (!place) return log_error("recording", "there is no black box: {}", place.error().text());
  const auto ns = [](double s) { return Nanoseconds(static_cast<std::int64_t>(1e9 * s)); };
  RecordingOptions options;
  RecordingRing ring;
  ring.folder = place->parent_path();
  ring.name = "blackbox-" + about_.instance;
  ring.file_length = ns(settings.file_s);
  ring.length = ns(settings.length_s);
  ring.most_bytes = settings.most_mb * 1'000'000;
  ring.keep_after = ns(settings.keep_after_s);
  options.ring = std::move(ring);
  options.topics = settings.topics;
  options.compression = mcap::compression_of(settings.compression).value_or(mcap::Compression::zstd);
  options.rate_hz = settings.rate_hz;
  options.tissue_rate_hz = settings.tissue_rate_hz;
  for (const RecordedPicture& one : settings.pictures) options.pictures.push_back({one.view, one.rate_hz});
  options.most_attached = settings.attach_mb * 1'000'000;
  fill_about(options);
  hub_.set_ring_options(std::move(options));
  if (!settings.enabled) return;
  if (auto started = hub_.switch_ring(true); !started)
    log_error("recording", "there is no black box: {}", started.error().text());
}

Result<void> Recordings::switch_ring(RecordAction action) {
  if (action == RecordAction::keep) return hub_.keep_ring();
  return hub_.switch_ring(action == RecordAction::on);
}

void Recordings::watch(Recorder::Sources sources) {
  sources.can_tap = &can_tap_;
  sources.payload_tap = &payload_tap_;
  sources.keeps_collisions = settings_.keep_on_collision;
  recorder_ = std::make_unique<Recorder>(std::move(sources), hub_);
}

void Recordings::stop() { recorder_.reset(); }

void Recordings::fill_about(RecordingOptions& options) const {
  options.about = {{"version", CELLMIRROR_VERSION},
                   {"instance", about_.instance},
                   {"cell", about_.cell},
                   {"loop_rate_hz", fmt::format("{}", about_.rate_hz)},
                   {std::string(kCellFileKey), about_.cell_file},
                   {std::string(kBuildKey), build_identity()},
                   {std::string(kTargetKey), std::string(compute_target())},
                   {std::string(kUtcKey), fmt::format("{}", to_wall_clock_ns(Timestamp{0}))},
                   {"record_rate_hz", fmt::format("{}", options.rate_hz)}};
  options.cell = about_.files;
}

Result<RecordingOptions> Recordings::options_of(const ControlRequest& request) const {
  RecordingOptions options;
  options.file = request.argument("file").value_or("");
  if (!options.file.is_absolute()) return fail("a recording needs an absolute path", "use cellmirror record -o F.mcap");
  options.topics = divided(request.argument("topics").value_or(""));
  if (options.topics.size() > kMostTopics) return fail(fmt::format("more than {} topics", kMostTopics));
  const auto compression = mcap::compression_of(request.argument("compression").value_or("zstd"));
  if (!compression) return fail("the compression is not known", "known: zstd, lz4, none");
  options.compression = *compression;
  const auto rate = number_of_argument(request, "rate_hz", options.rate_hz, 0.1, 4000.0);
  if (!rate) return std::unexpected(rate.error());
  options.rate_hz = *rate;
  const auto tissue_rate = number_of_argument(request, "tissue_rate_hz", options.tissue_rate_hz, 0.0, 30.0);
  if (!tissue_rate) return std::unexpected(tissue_rate.error());
  options.tissue_rate_hz = *tissue_rate;
  const auto length = number_of_argument(request, "for_s", 0.0, 0.0, kLongest_s);
  if (!length) return std::unexpected(length.error());
  options.length = Nanoseconds(static_cast<std::int64_t>(1e9 * *length));
  const auto attached =
      number_of_argument(request, "attach_mb", 1e-6 * static_cast<double>(kMostAttached), 0.0, kMostAttachedMegabytes);
  if (!attached) return std::unexpected(attached.error());
  options.most_attached = static_cast<std::uint64_t>(1e6 * *attached);
  for (const std::string& text : divided(request.argument("pictures").value_or(""))) {
    const auto picture = recorded_picture(text);
    if (!picture)
      return fail(fmt::format("{} is not a view with a rate", printable(text)), "write VIEW@HZ, with 0.01 to 10 Hz");
    options.pictures.push_back({picture->view, picture->rate_hz});
  }
  if (options.pictures.size() > kMostRecordedPictures)
    return fail(fmt::format("more than {} views are to be recorded", kMostRecordedPictures));
  options.lease = kLease;
  fill_about(options);
  return options;
}

std::string Recordings::answer(const ControlRequest& request) {
  const std::string action = request.argument("action").value_or("");
  Result<void> step;
  if (action == "start") {
    auto options = options_of(request);
    step = options ? hub_.start_file(*std::move(options)) : Result<void>(std::unexpected(options.error()));
  } else if (action == "stop" || action == "keep") {
    const bool done = action == "stop" ? hub_.end_file() : hub_.renew_file();
    if (!done) step = fail("nothing is being recorded");
  } else {
    step =
        fail(fmt::format("the action {} of a recording is not known", printable(action)), "known: start, keep, stop");
  }
  if (!step) return control_error(step.error());
  const auto report = hub_.file_report();
  return report ? dumped(recording_json(*report)) : control_error({"nothing is being recorded", {}});
}

}  // namespace cellmirror::app
