#include "app/subcommands/replay_gateway.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "app/console/load_progress.hpp"
#include "app/gateway/gateway.hpp"
#include "app/playback/played_recording.hpp"
#include "app/recording/recorded_cell.hpp"
#include "app/recording/recording_report.hpp"
#include "app/replay/verification.hpp"
#include "app/subcommands/end_signals.hpp"
#include "app/subcommands/resource_limits.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

namespace {

namespace fs = std::filesystem;

constexpr double kLookEvery_s = 0.05;

// The first error, and how many there are: a file that is not attached makes many.
std::string not_whole(const Diagnostics& findings) {
  for (const Diagnostic& finding : findings.all()) {
    if (finding.severity == Severity::error)
      return fmt::format("its attached files are not a whole cell ({}; the first: {})",
                         number_of(findings.errors(), "error"), finding.text());
  }
  return "its attached files are not a whole cell";
}

// Returns the file that the operator names, else the attached cell. Never opens a path from the recording: its author
// could make this process read any file.
Result<fs::path> cell_of(const mcap::Reader& reader, const ReplayGateway& options, const fs::path& folder) {
  if (!options.recorded_cell.empty()) return fs::path(options.recorded_cell);
  const auto attached = extract_cell(reader, folder);
  std::string why = attached ? std::string() : attached.error().text();
  if (attached) {
    Diagnostics findings;
    if (load_cell(attached->cell_file, findings)) return attached->cell_file;
    why = not_whole(findings);
  }
  return fail(fmt::format("{}: {}", options.file, why), recorded_cell_remedy(reader));
}

// The signal that ended it; 0: the recording has ended.
int serve(const EndSignals& signals, const PlayedRecording& recording, bool waits) {
  if (waits) return signals.wait(0);
  for (;;) {
    if (const int signal = signals.wait(kLookEvery_s); signal != 0) return signal;
    if (recording.control().state().status == PlaybackStatus::ended) return 0;
  }
}

}  // namespace

int play_recording(const ReplayGateway& options) {
  set_log_level(LogLevel::warning);
  report_exhausted_resources();
  if (auto enough = check_resource_limits(); !enough) return refuse(enough.error().text());
  const EndSignals signals;
  const SystemClock clock;
  PlayOptions play;
  play.file = options.file;
  play.limits = options.limits;
  play.from_s = options.from_s;
  play.to_s = options.to_s;
  play.speed = options.speed;
  play.playing = !options.paused;
  auto recording = PlayedRecording::open(play, clock);
  if (!recording) return refuse(recording.error().text());
  const mcap::Reader& reader = (*recording)->run().reader();
  if (!reader.indexed())
    log_warning(
        "replay.file",
        "{} was not ended in order ({}): it was read as a whole to be opened; write a file that opens at once: {}",
        options.file, reader.why_not_indexed(), recover_command(options.file));
  // Of the user alone, for the cell and for all that a gateway writes.
  auto folder = TemporaryFolder::make();
  if (!folder) return refuse(folder.error().text());
  const fs::path state = folder->path() / "state";
  const fs::path attached = folder->path() / "cell";
  std::error_code error;
  fs::create_directory(state, error);
  fs::create_directory(attached, error);
  fs::permissions(attached, fs::perms::owner_all, error);
  const auto cell = cell_of(reader, options, attached);
  if (!cell) return refuse(cell.error().text());
  GatewayOptions gateway_options;
  gateway_options.cell_file = *cell;
  gateway_options.foreign_cell = options.recorded_cell.empty();
  gateway_options.state = state;
  gateway_options.instance = options.instance;
  gateway_options.headless = options.headless;
  gateway_options.web = options.with_page();
  gateway_options.port = options.port;
  gateway_options.playback = recording->get();
  gateway_options.publish = options.publish;
  std::optional<ProgressLine> line("files loaded");
  gateway_options.progress = load_progress(*line);
  auto gateway = Gateway::start(gateway_options);
  line.reset();
  if (!gateway) return refuse(gateway.error().text());
  std::printf("%s\n", (*gateway)->greeting().c_str());
  std::fflush(stdout);
  const int signal = serve(signals, **recording, options.with_page() || options.wait);
  const std::string failure = (*recording)->control().failure();
  gateway->reset();
  if (signal == 0 && !failure.empty()) return refuse(fmt::format("{}: {}", options.file, failure));
  if (signal == 0 || is_ordinary_end(signal)) return kExitDone;
  return refuse(fmt::format("the replay was ended by {}", signal_text(signal)));
}

}  // namespace cellmirror::app
