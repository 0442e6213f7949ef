// The signals that end a running gateway: in order, whatever the signal.
#pragma once

#include <csignal>
#include <string>

namespace cellmirror::app {

// Takes every signal whose default action is the end of the process and that reports no error of the program: SIGHUP
// (the terminal is gone), SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO,
// SIGPWR, SIGSTKFLT and the real-time signals. They are blocked in this thread and in those that it starts, and taken
// by wait(), so that ending is ordinary code. Exceptions: a signal that is ignored at the start stays ignored (nohup; a
// shell's background jobs ignore SIGQUIT), but for SIGINT and SIGTERM; one with a handler (a profiler's) keeps it.
// SIGPIPE and SIGXFSZ (a limit of file sizes) are ignored: the call that causes them reports an error.
class EndSignals {
 public:
  // Before any other thread is started.
  EndSignals();

  // The signal that came; 0: none within `seconds`. 0 or less: without a limit.
  [[nodiscard]] int wait(double seconds) const;

 private:
  sigset_t signals_{};
};

// Whether an operator ends the gateway with it, as opposed to a limit or an accident: SIGHUP, SIGINT, SIGQUIT, SIGTERM.
[[nodiscard]] bool is_ordinary_end(int signal);
// "SIGXCPU"
[[nodiscard]] std::string signal_text(int signal);

}  // namespace cellmirror::app
