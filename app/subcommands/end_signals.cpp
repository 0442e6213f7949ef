#include "app/subcommands/end_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "rt_core/base/time.hpp"

namespace cellmirror::app {

namespace {

constexpr std::array kOrdinaryEnds{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
constexpr std::array kOtherEnds{SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT};

// A shell's background job ignores SIGINT too, and nevertheless ends when it is sent one.
bool is_taken(int signal) {
  if (signal == SIGINT || signal == SIGTERM) return true;
  struct sigaction action{};
  return ::sigaction(signal, nullptr, &action) == 0 && (action.sa_flags & SA_SIGINFO) == 0 &&
         action.sa_handler == SIG_DFL;
}

}  // namespace

EndSignals::EndSignals() {
  sigemptyset(&signals_);
  const auto take = [this](int signal) {
    if (is_taken(signal)) sigaddset(&signals_, signal);
  };
  std::ranges::for_each(kOrdinaryEnds, take);
  std::ranges::for_each(kOtherEnds, take);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) take(signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

int EndSignals::wait(double seconds) const {
  if (seconds <= 0) {
    int signal = 0;
    while (sigwait(&signals_, &signal) == EINTR) {
    }
    return signal;
  }
  const SystemClock clock;
  const Timestamp end = clock.now() + Nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
  for (Timestamp now = clock.now(); now < end; now = clock.now()) {
    const std::int64_t left = (end - now).count();
    const timespec timeout{left / 1'000'000'000, left % 1'000'000'000};
    if (const int signal = sigtimedwait(&signals_, nullptr, &timeout); signal > 0) return signal;
  }
  return 0;
}

bool is_ordinary_end(int signal) { return std::ranges::find(kOrdinaryEnds, signal) != kOrdinaryEnds.end(); }

std::string signal_text(int signal) {
  if (signal >= SIGRTMIN && signal <= SIGRTMAX) return fmt::format("SIGRTMIN+{}", signal - SIGRTMIN);
  const char* name = ::sigabbrev_np(signal);
  return name == nullptr ? fmt::format("signal {}", signal) : fmt::format("SIG{}", name);
}

}  // namespace cellmirror::app
