// cellmirror: the one program. See app/subcommands for what it does.
#include <CLI/CLI.hpp>
#include <exception>
#include <string>

#include "app/subcommands/subcommand.hpp"

int main(int argc, char** argv) {
  using namespace cellmirror::app;
  try {
    CLI::App cli(
        "Mirrors a robot workcell in real time and takes SCRIPT commands.\n\n"
        "  cellmirror run config/cells/transfer_cell/cell.toml     start the gateway of a cell\n"
        "  cellmirror status --watch                               what it does now\n"
        "  cellmirror send 'POS_ROB PUMA_762 JOINT_INC 5'          command it\n"
        "  cellmirror doctor                                       what this machine allows");
    cli.name("cellmirror");
    cli.require_subcommand(1);
    cli.set_version_flag("--version", "cellmirror " CELLMIRROR_VERSION);
    Action action;
    add_run(cli, action);
    add_send(cli, action);
    add_status(cli, action);
    add_check(cli, action);
    add_commands(cli, action);
    add_doctor(cli, action);
    add_fk(cli, action);
    add_ik(cli, action);
    add_collide(cli, action);
    add_range(cli, action);
    try {
      cli.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return cli.exit(error) == 0 ? kExitDone : kExitUsage;
    }
    return action();
  } catch (const std::exception& error) {
    return refuse(std::string("unexpected failure: ") + error.what() + "; this is a bug, please report it");
  }
}
