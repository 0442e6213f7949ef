// The subcommands of `cellmirror`, a file each. A subcommand adds itself to the command line and leaves in `action`
// what to do when the user named it.
#pragma once

#include <functional>
#include <string>

namespace cellmirror::cli {
class Command;
}

namespace cellmirror::app {

inline constexpr int kExitDone = 0;     // done
inline constexpr int kExitRefused = 1;  // refused or failed, with a message on standard error
// 2 is wrong usage: cli::kExitWrongUsage.

using Action = std::function<int()>;

void add_new(cli::Command program, Action& action);
void add_run(cli::Command program, Action& action);
void add_send(cli::Command program, Action& action);
void add_status(cli::Command program, Action& action);
void add_check(cli::Command program, Action& action);
void add_commands(cli::Command program, Action& action);
void add_doctor(cli::Command program, Action& action);
void add_fk(cli::Command program, Action& action);
void add_ik(cli::Command program, Action& action);
void add_collide(cli::Command program, Action& action);
void add_range(cli::Command program, Action& action);
void add_snapshot(cli::Command program, Action& action);
void add_page(cli::Command program, Action& action);
void add_simulate(cli::Command program, Action& action);
void add_fault(cli::Command program, Action& action);
void add_record(cli::Command program, Action& action);
void add_recording(cli::Command program, Action& action);
void add_replay(cli::Command program, Action& action);
void add_volume(cli::Command program, Action& action);
void add_wall(cli::Command program, Action& action);

// Prints "cellmirror: what; remedy" on standard error and gives kExitRefused.
int refuse(const std::string& what);

}  // namespace cellmirror::app
