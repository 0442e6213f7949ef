// cellmirror fault: injects a fault into a node that the running gateway answers for.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/console/put.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/instance.hpp"

namespace cellmirror::app {

namespace {

constexpr std::chrono::seconds kFaultTimeout{5};

struct FaultOptions {
  int node = 0;
  std::string fault;
  double seconds = 0;
  std::string channel;
  std::string instance{kDefaultInstance};
};

int fault(const FaultOptions& options) {
  ControlRequest request{"fault", {{"node", fmt::format("{}", options.node)}}};
  if (options.fault == "end") {
    request.arguments.emplace_back("end", "true");
  } else {
    request.arguments.emplace_back("fault", options.fault);
    request.arguments.emplace_back("for_s", fmt::format("{}", options.seconds));
  }
  if (!options.channel.empty()) request.arguments.emplace_back("channel", options.channel);
  const auto answer = control_request(options.instance, control_request_line(request), kFaultTimeout);
  if (!answer) return refuse(answer.error().text());
  return kExitDone;
}

}  // namespace

void add_fault(cli::Command program, Action& action) {
  auto options = std::make_shared<FaultOptions>();
  cli::Command sub = program.subcommand(
      "fault", "Inject a fault into a drive or I/O node that answers a controller, or end its faults");
  sub.option("node", options->node, "number of the node in the cell file").required().between(1, 127);
  sub.option("fault", options->fault, "the fault, or end: all faults of the node end").required();
  sub.option("--for", options->seconds, "seconds that it lasts; 0: until it is ended")
      .between(0.0, 86'400.0)
      .show_default();
  sub.option("--channel", options->channel, "channel of the node, where several nodes have the number");
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.footer(
      "Faults: death                               no power: silent and deaf, then it boots\n"
      "        loss[:p=P][,only=WHAT]              frames vanish, all or with the probability P\n"
      "        delay:s=S[,only=WHAT]               frames leave later\n"
      "        emergency:code=CODE                 the drive fails; an I/O node reports the error\n"
      "        stuck:bit=N,value=0|1               digital input of an I/O node, from 0\n"
      "        stuck:channel=N,value=V             analogue input, from 1\n"
      "WHAT:   heartbeat, sdo, pdo, emergency\n"
      "Examples:\n"
      "  cellmirror fault 11 loss:only=heartbeat --for 2\n"
      "  cellmirror fault 11 emergency:code=0x2310\n"
      "  cellmirror fault 20 stuck:bit=0,value=1\n"
      "  cellmirror fault 20 end\n"
      "docs/hardware-in-the-loop.md");
  sub.when_named([options, &action] { action = [options] { return fault(*options); }; });
}

}  // namespace cellmirror::app
