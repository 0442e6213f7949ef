// cellmirror send 'COMMAND': one SCRIPT command by message, with its acknowledgement.
#include <cctype>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/sysv/script_client.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

struct SendOptions {
  std::string command;
  double timeout_s = 30.0;  // a robot may take so long to arrive
  std::string instance{kDefaultInstance};
};

constexpr const char* kStillMoving =
    "; POS_ROB is answered when the robot has arrived, and it may still be on its way: cellmirror status shows it, "
    "--timeout waits longer, STOP_ROB stops it";

bool moves_a_robot(std::string_view command) {
  constexpr std::string_view kWord = "POS_ROB";
  while (!command.empty() && std::isspace(static_cast<unsigned char>(command.front())) != 0) command.remove_prefix(1);
  return command.size() > kWord.size() && equal_ignoring_case(command.substr(0, kWord.size()), kWord);
}

int send(const SendOptions& options) {
  const auto instance = find_instance(options.instance);
  if (!instance) return refuse(instance.error().text());
  const Nanoseconds timeout(static_cast<std::int64_t>(options.timeout_s * 1e9));
  const auto reply = send_command(instance->queues, options.command, timeout);
  if (!reply) return refuse(reply.error().text() + (moves_a_robot(options.command) ? kStillMoving : ""));
  if (!reply->done) return refuse("refused: " + reply->text);
  std::printf("done%s%s\n", reply->text.empty() ? "" : " ", reply->text.c_str());
  return kExitDone;
}

}  // namespace

void add_send(cli::Command program, Action& action) {
  auto options = std::make_shared<SendOptions>();
  cli::Command sub =
      program.subcommand("send", "Send one SCRIPT command to the running gateway and print its acknowledgement");
  sub.option("command", options->command, "the command, in quotes").required();
  sub.option("--timeout", options->timeout_s, "seconds to wait for the acknowledgement").positive().show_default();
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.footer("Example: cellmirror send 'ROBOT PUMA_762 online'\nList of commands: cellmirror commands");
  sub.when_named([options, &action] { action = [options] { return send(*options); }; });
}

}  // namespace cellmirror::app
