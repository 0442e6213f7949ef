// cellmirror status: what the running gateway does now.
#include <unistd.h>

#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/subcommands/status_table.hpp"
#include "app/subcommands/stream_wait.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/instance.hpp"

namespace cellmirror::app {

namespace {

struct StatusOptions {
  bool json = false;
  bool watch = false;
  std::string instance{kDefaultInstance};
  std::string wait_for;  // a state; empty: does not wait
  std::vector<std::string> robots;
  double timeout_s = 30;
};

constexpr std::chrono::seconds kObserverTimeout{5};
constexpr std::chrono::milliseconds kLookAgain{100};

// "name: what it is" for the other gateways that run, for the message about an unknown instance.
std::string others() {
  const auto running = running_instances();
  if (!running || running->empty()) return {};
  std::string out = "; running:";
  for (const InstanceInfo& info : *running) out += " " + info.name;
  return out;
}

int print_once(const StatusOptions& options) {
  const auto document = control_request(options.instance, R"({"request":"status"})", kObserverTimeout);
  if (!document) return refuse(document.error().text() + others());
  if (options.json) {
    std::printf("%s\n", document->c_str());
    return kExitDone;
  }
  const auto table = status_table(*document, isatty(STDOUT_FILENO) == 1);
  if (!table) return refuse(table.error().text());
  std::fputs(table->c_str(), stdout);
  return kExitDone;
}

Result<StreamWaitResult> streams_of(const std::string& document, const StreamWait& wanted) {
  try {
    return look_at_streams(nlohmann::json::parse(document), wanted);
  } catch (const nlohmann::json::exception& error) {
    return fail(fmt::format("the gateway's status cannot be read: {}", error.what()),
                "gateway and this program may be of different versions");
  }
}

// A gateway that does not answer yet may still start.
int wait_for_streams(const StreamWait& wanted, const StatusOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto limit = std::chrono::duration<double>(options.timeout_s);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
  for (;;) {
    const auto document = control_request(options.instance, R"({"request":"status"})", kObserverTimeout);
    const auto streams = document ? streams_of(*document, wanted) : StreamWaitResult{};
    if (!streams) return refuse(streams.error().text());
    const std::string missing = document ? streams->missing : document.error().text() + others();
    if (missing.empty()) {
      const std::string there = fmt::format("{}: {}", wanted.state, fmt::join(streams->there, ", "));
      std::printf("%s\n", options.json ? document->c_str() : there.c_str());
      return kExitDone;
    }
    if (Clock::now() >= end)
      return refuse(fmt::format("not {} after {:g} s: {}", wanted.state, options.timeout_s, missing));
    std::this_thread::sleep_for(kLookAgain);
  }
}

int show(const StatusOptions& options) {
  if (!options.wait_for.empty()) return wait_for_streams({options.wait_for, options.robots}, options);
  if (!options.watch) return print_once(options);
  for (;;) {
    std::fputs("\x1b[H\x1b[2J", stdout);
    if (const int exit_code = print_once(options); exit_code != kExitDone) return exit_code;
    std::fflush(stdout);
    const timespec second{1, 0};
    nanosleep(&second, nullptr);
  }
}

}  // namespace

void add_status(cli::Command program, Action& action) {
  auto options = std::make_shared<StatusOptions>();
  cli::Command sub = program.subcommand("status", "Show what the running gateway does now");
  auto json = sub.flag("--json", options->json, "one JSON document (docs/status.md)");
  auto watch = sub.flag("--watch", options->watch, "refresh every second until Ctrl-C").excludes(json);
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  auto wait =
      sub.option("--wait", options->wait_for, "wait until the streams of all robots that are online have this state")
          .one_of({"fresh", "stale", "lost", "invalid", "implausible", "conflict"})
          .excludes(watch);
  sub.option("--robot", options->robots, "wait for this robot only; may be repeated").one_value_each().needs(wait);
  sub.option("--timeout", options->timeout_s, "wait so many seconds at most, then exit with 1")
      .show_default()
      .between(0.0, 1e6)
      .needs(wait);
  sub.footer(
      "Examples: cellmirror status --json | jq '.robots[] | {id, mode}'\n"
      "          cellmirror status --wait fresh --robot PUMA_762 --timeout 10 && ./my-test");
  sub.when_named([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace cellmirror::app
