#include "sim_devices/haptic/second_writer.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "ipc/wire/haptic_block.hpp"
#include "ipc/wire/shared_words.hpp"
#include "sim_devices/base/pacer.hpp"

namespace cellmirror::sim {
namespace {

// The copy of a process with threads may only do what a signal handler may: memory, clock and sleep.
[[noreturn]] void write_on(std::span<std::byte> memory, HapticSample sample, Nanoseconds period, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const SystemClock clock;
  sample.writer = static_cast<std::uint32_t>(::getpid());
  // Not quite the device's own period: with it, one of the two could be the last before each tick for ever.
  const Nanoseconds own_period(std::max<std::int64_t>(period.count() * 93 / 100, 1));
  Pacer pacer(clock.now() + period / 2, own_period);
  while (::getppid() == parent) {
    sleep_until(pacer.next());
    const Timestamp now = clock.now();
    pacer.advance(now);
    ++sample.sequence;
    sample.time = now;
    write_haptic_sample(memory, sample);
  }
  ::_exit(0);
}

}  // namespace

void SecondWriter::begin(std::span<std::byte> memory, const HapticSample& sample, Nanoseconds period) {
  if (runs()) return;
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ == 0) write_on(memory, sample, period, parent);
}

void SecondWriter::end() {
  if (!runs()) return;
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
  child_ = -1;
}

void tear(std::span<std::byte> memory) {
  if (memory.size() < haptic_block_offset::kSize) return;
  shared_words::at<std::uint64_t>(memory, haptic_block_offset::kDeviceLock).fetch_or(1);
  shared_words::at<std::uint64_t>(memory, haptic_block_offset::kDeviceSequence).fetch_add(1);
  shared_words::store_f64(memory, haptic_block_offset::kPosition, 1.0);
}

}  // namespace cellmirror::sim
