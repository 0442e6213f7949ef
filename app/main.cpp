// cellmirror: the one program. See app/subcommands for what it does.
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <system_error>

#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace cellmirror::app;
  try {
    cellmirror::cli::CommandLine program(
        "Mirrors a robot workcell in real time and takes SCRIPT commands.\n\n"
        "  cellmirror new my_cell --urdf arm.urdf                  a cell folder for a robot of your own\n"
        "  cellmirror run config/cells/transfer_cell/cell.toml     start the gateway of a cell\n"
        "  cellmirror status --watch                               what it does now\n"
        "  cellmirror page                                         where its monitor page is\n"
        "  cellmirror send 'POS_ROB PUMA_762 JOINT_INC 5'          command it\n"
        "  cellmirror wall                                         one page for many cells\n"
        "  cellmirror doctor                                       check this machine",
        "cellmirror");
    program.require_subcommand();
    program.version("cellmirror " CELLMIRROR_VERSION);
    Action action;
    add_new(program, action);
    add_run(program, action);
    add_send(program, action);
    add_status(program, action);
    add_check(program, action);
    add_commands(program, action);
    add_doctor(program, action);
    add_fk(program, action);
    add_ik(program, action);
    add_collide(program, action);
    add_range(program, action);
    add_snapshot(program, action);
    add_page(program, action);
    add_simulate(program, action);
    add_fault(program, action);
    add_record(program, action);
    add_recording(program, action);
    add_replay(program, action);
    add_volume(program, action);
    add_wall(program, action);
    if (const std::optional<int> status = program.parse(argc, argv)) return *status;
    return action();
  } catch (const std::bad_alloc&) {
    return refuse("out of memory; raise the limits (ulimit -v, ulimit -l), or end other programs");
  } catch (const std::system_error& error) {
    return refuse(std::string("the machine refuses what is needed: ") + error.what() +
                  "; see the limits of processes, files and memory (ulimit -a)");
  } catch (const std::exception& error) {
    return refuse(std::string("unexpected failure: ") + error.what() + "; this is a bug, please report it");
  }
}
