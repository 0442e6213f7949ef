#include "app/gateway/loaded_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "app/io/robot_streams.hpp"
#include "app/playback/played_recording.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kMostScripts = 256;

// Numbered, so that none falls to the log's rate limit by kind.
void log_findings(const Diagnostics& diagnostics) {
  std::size_t number = 0;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    ++number;
    log_text(diagnostic.severity == Severity::note ? LogLevel::info : LogLevel::warning,
             fmt::format("cell {}/{}", number, diagnostics.all().size()), diagnostic.text());
  }
}

// Serves the page of a replay on loopback only, at the port that the operator chooses.
void keep_page_here(WebSettings& page) {
  page.enabled = true;
  page.address = WebSettings().address;
  page.port.reset();
  page.origins.clear();
}

// Limits the outputs of --publish: DDS on loopback, no MQTT broker, and the message queues of the instance.
void keep_outputs_here(LoadedCell& cell) {
  cell.mqtt.enabled = false;
  cell.dds.interface_address = DdsOutputConfig().interface_address;
  cell.dds.security = {};
  cell.dds_network = {};
  const std::optional<double> sensor_rate_hz = cell.queues.sensor_rate_hz;
  cell.queues = {};
  cell.queues.sensor_rate_hz = sensor_rate_hz;
}

}  // namespace

Result<LoadedCell> load_cell_of(const GatewayOptions& options) {
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded = load_cell(options.cell_file, diagnostics, options.progress);
  if (!loaded) {
    const std::string count = diagnostics.errors() == 1 ? "an error" : fmt::format("{} errors", diagnostics.errors());
    return fail(fmt::format("the cell {} has {}:\n{}nothing was started", options.cell_file.string(), count,
                            diagnostics.text(Severity::warning)),
                fmt::format("fix the cell and check it with: cellmirror check {}", options.cell_file.string()));
  }
  // A robot whose stream cannot be made is still there to be simulated; online refuses it with the same diagnostics.
  if (options.playback == nullptr) {
    for (const RobotStream& stream : loaded->streams) check_robot_stream(stream, diagnostics);
  }
  log_findings(diagnostics);
  if (!options.state.empty()) {
    auto home = loaded->home.with_state(options.state);
    if (!home) return std::unexpected(home.error());
    loaded->home = *std::move(home);
  }
  if (options.rate_hz) loaded->loop.rate_hz = *options.rate_hz;
  if (options.playback != nullptr) {
    loaded->loop.rate_hz = options.playback->rate_hz();
    keep_page_here(loaded->web);
  }
  if (options.foreign_cell) keep_outputs_here(*loaded);
  return std::move(*loaded);
}

std::vector<std::filesystem::path> files_of(const LoadedCell& cell) {
  std::vector<std::filesystem::path> files = cell.files;
  files.insert(files.begin(), std::filesystem::absolute(cell.file).lexically_normal());
  // What the startup script says is part of the cell: views, what is sent, workframes that it moves.
  std::error_code error;
  std::vector<std::filesystem::path> scripts;
  for (const auto& entry : std::filesystem::directory_iterator(cell.home.root() / "scripts", error)) {
    if (scripts.size() < kMostScripts && entry.is_regular_file(error)) scripts.push_back(entry.path());
  }
  std::ranges::sort(scripts);
  files.insert(files.end(), scripts.begin(), scripts.end());
  return files;
}

}  // namespace cellmirror::app
