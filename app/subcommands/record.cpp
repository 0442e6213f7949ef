// cellmirror record: records what the running gateway publishes, until Ctrl-C or for some seconds.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/console/put.hpp"
#include "app/subcommands/status_table_recordings.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/instance.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::chrono::seconds kAnswerTimeout{5};
constexpr timespec kBetweenLooks{0, 200'000'000};
constexpr int kLongestEnd = 150;  // looks: half a minute for what is in the buffer

struct RecordOptions {
  std::string output;
  std::vector<std::string> topics;
  std::vector<std::string> pictures;
  double seconds = 0;
  double rate_hz = 100;
  double tissue_rate_hz = 10;
  double attach_mb = 64;
  std::string compression = "zstd";
  std::string instance{kDefaultInstance};
  bool json = false;
};

volatile std::sig_atomic_t recording_is_over = 0;

Result<json> ask(const RecordOptions& options, const ControlRequest& request) {
  const auto text = control_request(options.instance, control_request_line(request), kAnswerTimeout);
  if (!text) return std::unexpected(text.error());
  json report = json::parse(*text, nullptr, /*allow_exceptions=*/false);
  if (!report.is_object() || !report.contains("ended") || !report.contains("why") || !report.contains("topics"))
    return fail("the answer of the gateway is no report of a recording", "use the program of the same version");
  return report;
}

ControlRequest action_request(const char* action) { return {"record", {{"action", action}}}; }

ControlRequest start_request(const RecordOptions& options) {
  const auto joined = [](const std::vector<std::string>& texts) {
    std::string out;
    for (const std::string& text : texts) out += (out.empty() ? "" : ",") + text;
    return out;
  };
  return {"record",
          {{"action", "start"},
           {"file", std::filesystem::absolute(options.output).lexically_normal().string()},
           {"topics", joined(options.topics)},
           {"pictures", joined(options.pictures)},
           {"compression", options.compression},
           {"rate_hz", fmt::format("{}", options.rate_hz)},
           {"tissue_rate_hz", fmt::format("{}", options.tissue_rate_hz)},
           {"attach_mb", fmt::format("{}", options.attach_mb)},
           {"for_s", fmt::format("{}", options.seconds)}}};
}

int report_end(const RecordOptions& options, const json& report) {
  const auto why = report.at("why").get<std::string>();
  if (options.json) {
    put(stdout, "{}\n", report.dump(-1, ' ', false, json::error_handler_t::replace));
  } else {
    put(stdout, "{}: {}\n", options.output, recording_figures(report));
    for (const json& topic : report.at("topics")) {
      if (const auto dropped = topic.at("dropped").get<std::uint64_t>(); dropped > 0)
        put(stderr, "cellmirror: {}: {} dropped\n", topic.at("topic").get<std::string>(), dropped);
    }
  }
  if (!why.empty()) return refuse("the recording has ended: " + why);
  return kExitDone;
}

int record(const RecordOptions& options) {
  // The second one ends this program at once; the gateway ends the recording then.
  std::signal(SIGINT, [](int) {
    recording_is_over = 1;
    std::signal(SIGINT, SIG_DFL);
  });
  std::signal(SIGTERM, [](int) { recording_is_over = 1; });
  auto report = ask(options, start_request(options));
  if (!report) return refuse(report.error().text());
  if (!options.json) {
    put(stderr, "recording into {}{}\n", options.output, options.seconds > 0 ? "" : "; Ctrl-C ends it");
  }
  for (int looks_after_end = 0; !report->at("ended").get<bool>() && looks_after_end < kLongestEnd;) {
    nanosleep(&kBetweenLooks, nullptr);
    const bool over = recording_is_over != 0;
    if (over) ++looks_after_end;
    report = ask(options, action_request(over ? "stop" : "keep"));
    if (!report) return refuse(report.error().text());
  }
  if (!report->at("ended").get<bool>()) return refuse("the gateway has not finished the file yet; it continues");
  return report_end(options, *report);
}

std::string wrong_output(const std::string& text) {
  return text.ends_with(".mcap") ? std::string() : fmt::format("'{}': recordings are .mcap", text);
}

}  // namespace

void add_record(cli::Command program, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  cli::Command sub = program.subcommand("record", "Record what the running gateway publishes as an MCAP file");
  sub.option("-o,--output", options->output, "a new file").required().check(wrong_output, "F.mcap");
  sub.option("--for", options->seconds, "end after this many seconds; else by Ctrl-C").positive();
  sub.option("--topics", options->topics, "only these, e.g. /joint_states,/cellmirror/*").list_divided_by(',');
  sub.option("--pictures", options->pictures,
             "views as pictures: VIEW@HZ,..., a view (0 to 6) or a camera, at most 10 Hz")
      .list_divided_by(',');
  sub.option("--rate", options->rate_hz, "robot states a second, at most as many as the loop has periods")
      .between(0.1, 4000.0)
      .show_default();
  sub.option("--tissue-rate", options->tissue_rate_hz, "surfaces of deformable objects a second at most; 0: none")
      .between(0.0, 30.0)
      .show_default();
  sub.option("--attach-mb", options->attach_mb, "megabytes of the cell's files that are attached at most")
      .between(0.0, 1024.0)
      .show_default();
  sub.option("--compression", options->compression, "of the file").one_of({"zstd", "lz4", "none"}).show_default();
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.flag("--json", options->json, "one JSON document at the end (docs/recording.md)");
  sub.footer(
      "The gateway writes the file; it ends it where this program is gone for 10 s.\n"
      "Example: cellmirror record -o drive.mcap --for 60\n"
      "         cellmirror recording info drive.mcap");
  sub.when_named([options, &action] { action = [options] { return record(*options); }; });
}

}  // namespace cellmirror::app
