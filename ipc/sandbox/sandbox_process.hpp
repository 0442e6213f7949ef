// One run of a confined program: its start, the checks while it runs, and its end. One thread, which has to outlive the
// object, since the kernel ends the process together with the thread that started it. Not for the loop.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/child_process.hpp"
#include "ipc/sandbox/sandbox_report.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

struct SandboxConfig {
  std::string program;           // file name, found by program_beside_this()
  std::string subject;           // shown in status and in lists of processes
  std::string consequence = {};  // of its absence, for problems in status; empty: the user of the class reports these
  ChannelConfig channel;
  std::uint64_t memory_bytes = 512ULL << 20U;  // limit of the resident memory
  // Limit of continuous processor time with hardly any message, s. A malformed datagram can keep a library in an
  // endless loop; many participants that appear at once need some seconds.
  double most_fruitless_s = 30;
};

class SandboxProcess {
 public:
  static constexpr Nanoseconds kCheckEvery{100'000'000};
  // Limit of consecutive checks without a sign of life. It counts checks instead of time, so that a stall of the whole
  // machine does not count. The next check notices a process that was stopped or has ended.
  static constexpr int kMostSilentChecks = 30;
  static constexpr std::uint64_t kMostMessagesPerSecond = 400'000;
  static constexpr std::uint64_t kMostIdleWakesPerSecond = 50'000;

  // Fails if the program cannot be started. The text of an error is part of a sentence.
  [[nodiscard]] static Result<std::unique_ptr<SandboxProcess>> start(const SandboxConfig& config,
                                                                     std::shared_ptr<SandboxRecord> record);

  [[nodiscard]] Channel& channel() { return channel_; }
  [[nodiscard]] pid_t id() const { return child_.id(); }

  // Replaces the content of `out` by the oldest message. Returns false if there is none, or if the memory is damaged;
  // check() reports the latter.
  bool receive(std::vector<std::byte>& out);
  // Channel::wait(), limited to kCheckEvery. `also`: a descriptor, or -1.
  void wait(Nanoseconds timeout, int also);
  // To be called at least every kCheckEvery; calls in between cost nothing. Ends a process that has to be replaced and
  // returns the reason, e.g. "was ended by signal 6 (SIGABRT)". Returns nothing while the process is healthy.
  [[nodiscard]] std::optional<std::string> check(Timestamp now);
  // Ends the process. Returns the reason of a process that had ended by itself, else `why`.
  [[nodiscard]] std::string end(const std::string& why);

 private:
  SandboxProcess(Channel channel, ChildProcess child, const SandboxConfig& config,
                 std::shared_ptr<SandboxRecord> record);
  [[nodiscard]] std::optional<std::string> fault(Timestamp now);
  [[nodiscard]] std::string reason_of_exit();
  [[nodiscard]] std::optional<std::string> fruitless(double messages_per_second);
  [[nodiscard]] std::optional<std::string> flood(Timestamp now);

  Channel channel_;
  ChildProcess child_;
  std::uint64_t memory_limit_;
  double most_fruitless_s_;
  std::shared_ptr<SandboxRecord> record_;
  Timestamp next_check_;
  std::uint64_t last_beats_ = 0;
  int silent_checks_ = 0;
  double processor_s_ = 0;  // processor time up to the last count
  double fruitless_s_ = 0;
  Timestamp counted_since_;
  std::uint64_t messages_ = 0;  // since counted_since_
  std::uint64_t wakes_ = 0;     // likewise
};

}  // namespace cellmirror
