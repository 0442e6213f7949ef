// cellmirror new NAME: the folder of a new cell, from the files of a robot.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/load_progress.hpp"
#include "app/new_cell/new_cell.hpp"
#include "app/new_cell/questions.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

struct NewOptions {
  std::string folder;
  std::string urdf;
  std::string base;
  std::vector<double> xyz_m;
  std::vector<std::string> eds;
  std::vector<std::string> nodes;
  std::string dbc;
  std::optional<std::string> topic;
  std::optional<std::string> channel;
};

// Each value was checked by the command line.
NewCellRequest request_of(const NewOptions& options) {
  NewCellRequest request;
  request.folder = options.folder;
  // "cells/mine/" is the folder "mine".
  if (request.folder.filename().empty()) request.folder = request.folder.parent_path();
  request.urdf = options.urdf;
  request.base = options.base;
  for (std::size_t i = 0; i < options.xyz_m.size() && i < 3; ++i) request.xyz_m[i] = options.xyz_m[i];
  request.eds.assign(options.eds.begin(), options.eds.end());
  for (const std::string& node : options.nodes)
    request.nodes.push_back(static_cast<std::uint8_t>(parse_integer(node).value_or(0)));
  request.dbc = options.dbc;
  request.topic = options.topic;
  request.channel = options.channel.value_or(request.channel);
  return request;
}

void print_summary(const NewCellRequest& request, const CellPlan& plan) {
  const std::string folder = request.folder.string();
  std::printf("%s: a cell with %s\n", folder.c_str(), number_of(plan.robots.size(), "robot").c_str());
  for (const std::string& guess : plan.guesses) std::printf("  guessed: %s\n", guess.c_str());
  std::printf(
      "Next: confirm the guesses (grep -rn DECIDE %s), read %s/README.md, and start it:\n  cellmirror run "
      "%s/cell.toml\n",
      folder.c_str(), folder.c_str(), folder.c_str());
}

int make_new_cell(const NewOptions& options) {
  NewCellRequest request = request_of(options);
  const bool person = ::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1;
  const Told told{.xyz = !options.xyz_m.empty(), .channel = options.channel.has_value()};
  if (person && !ask_for_rest(request, told, std::cin, std::cout)) return refuse("no answer; nothing was written");
  if (const auto sound = check_request(request); !sound) {
    std::fprintf(stderr, "cellmirror new: %s\nRun with --help for more information.\n", sound.error().text().c_str());
    return cli::kExitWrongUsage;
  }
  const bool other_home = std::getenv("kis_home") != nullptr;
  Diagnostics diagnostics;
  const auto plan = plan_new_cell(request, diagnostics);
  bool written = false;
  if (plan) {
    ProgressLine line("files checked");
    written = write_new_cell(request, *plan, load_progress(line), diagnostics);
  }
  std::fputs(diagnostics.text(Severity::warning).c_str(), stderr);
  if (!written) return refuse("nothing was written");
  print_summary(request, *plan);
  if (other_home) std::printf("$kis_home is set: it takes the place of the cell's folder until you unset it.\n");
  return kExitDone;
}

std::string not_a_node(const std::string& text) {
  const auto id = parse_integer(text);
  return id && *id >= 1 && *id <= 127 ? std::string() : printable(text) + " is not a node id, 1 to 127";
}

}  // namespace

void add_new(cli::Command program, Action& action) {
  auto options = std::make_shared<NewOptions>();
  cli::Command sub = program.subcommand("new", "Make the folder of a new cell from the files of a robot");
  sub.option("name", options->folder, "folder to make; its last part is the name of the cell").required();
  sub.option("--urdf", options->urdf, "URDF of the robot; its meshes are copied with it");
  sub.option("--base", options->base, "link that is placed at --xyz; default: the root link");
  sub.option("--xyz", options->xyz_m, "where the robot stands, in metres; default: 0 0 0").values(3);
  sub.option("--topic", options->topic, "ROS 2 topic of its joint states; default: /joint_states");
  sub.option("--eds", options->eds, "EDS or DCF of CiA 402 drives: one for all nodes, or one for each")
      .one_value_each();
  sub.option("--node", options->nodes, "CANopen node ids of the drives, in the order of the joints")
      .check(not_a_node, "1..127");
  sub.option("--dbc", options->dbc, "DBC with the signals of joints");
  sub.option("--channel", options->channel, "CAN channel; default: socketcan:can0");
  sub.footer(
      "On a terminal it asks for missing options. Drives and signals drive the joints of the robot if they are as "
      "many\n"
      "and --topic is not given; else they become a robot of their own. Nothing is overwritten; after an error "
      "nothing\n"
      "is written.\n"
      "Examples: cellmirror new my_cell --urdf ur5e.urdf --topic /joint_states\n"
      "          cellmirror new cells/line_3 --urdf arm.urdf --base base_link --xyz 0 0 0.8 --eds axis.eds --node 11");
  sub.when_named([options, &action] { action = [options] { return make_new_cell(*options); }; });
}

}  // namespace cellmirror::app
