// The subcommands of `cellmirror`, a file each. A subcommand adds itself to the command line and leaves in `action`
// what to do when the user named it.
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace cellmirror::app {

inline constexpr int kExitDone = 0;     // done
inline constexpr int kExitRefused = 1;  // refused or failed, with a message on standard error
inline constexpr int kExitUsage = 2;    // wrong usage

using Action = std::function<int()>;

void add_run(CLI::App& cli, Action& action);
void add_send(CLI::App& cli, Action& action);
void add_status(CLI::App& cli, Action& action);
void add_check(CLI::App& cli, Action& action);
void add_commands(CLI::App& cli, Action& action);
void add_doctor(CLI::App& cli, Action& action);
void add_fk(CLI::App& cli, Action& action);
void add_ik(CLI::App& cli, Action& action);
void add_collide(CLI::App& cli, Action& action);
void add_range(CLI::App& cli, Action& action);

// Prints "cellmirror: what; remedy" on standard error and gives kExitRefused.
int refuse(const std::string& what);

}  // namespace cellmirror::app
