// Signs of life of a confined process while its thread is in a call of a library that may take long.
#pragma once

#include <atomic>
#include <ctime>
#include <thread>

#include "ipc/sandbox/channel.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// Beats from a thread of its own, as long as it exists.
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
