// Signs of life of a confined process during a long call of a library.
#pragma once

#include <atomic>
#include <ctime>
#include <thread>

#include "ipc/sandbox/channel.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Beats from a thread of its own while it exists.
class Beating {
 public:
  explicit Beating(Channel& channel)
      : thread_([this, &channel] {
          constexpr timespec kPause{0, 50'000'000};
          for (; !stop_.load(); nanosleep(&kPause, nullptr)) channel.beat();
        }) {}
  ~Beating() {
    stop_.store(true);
    thread_.join();
  }
  Beating(const Beating&) = delete;
  Beating& operator=(const Beating&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace cellmirror
