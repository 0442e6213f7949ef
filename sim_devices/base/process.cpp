#include "sim_devices/base/process.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <csignal>

namespace cellmirror::sim {
namespace {

volatile std::sig_atomic_t g_signalled = 0;

void on_signal(int) { g_signalled = 1; }

}  // namespace

void install_signal_handlers() {
  struct sigaction action{};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

bool signalled() { return g_signalled != 0; }

bool become_punctual(int priority) {
  prctl(PR_SET_TIMERSLACK, 1UL);
  if (priority <= 0) return true;
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace cellmirror::sim
