#include "sim_devices/base/pacer.hpp"

#include <ctime>

namespace cellmirror::sim {

void sleep_until(Timestamp t) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const timespec at{static_cast<std::time_t>(t.ns / kSecond), static_cast<long>(t.ns % kSecond)};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

}  // namespace cellmirror::sim
