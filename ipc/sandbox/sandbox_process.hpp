// One run of a confined program: started, watched, ended. One thread, which outlives it: the kernel ends the process
// with the thread that started it. Not for the loop.
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
  std::string program;  // beside ours (program_beside_this)
  std::string subject;  // for status and lists of processes
  ChannelConfig channel;
  std::uint64_t memory_bytes = 512ULL << 20U;  // resident; it is ended beyond that
  // Processor time in which it has said next to nothing and did not rest, of a library that loops over a malformed
  // datagram for ever. Many participants that appear at once take some seconds, too.
  double most_fruitless_s = 30;
};

class SandboxProcess {
 public:
  static constexpr Nanoseconds kLookEvery{100'000'000};
  // Looks in a row in which it gave no sign of life. Counted in looks, not in time: a machine that stalls as a whole
  // does not count against it. One that was stopped or has ended is noticed at the next look.
  static constexpr int kMostSilentLooks = 30;
  static constexpr std::uint64_t kMostMessagesPerSecond = 400'000;
  static constexpr std::uint64_t kMostIdleWakesPerSecond = 50'000;

  // Fails where the program cannot be started; an error is part of a sentence.
  [[nodiscard]] static Result<std::unique_ptr<SandboxProcess>> start(const SandboxConfig& config,
                                                                     std::shared_ptr<SandboxRecord> record);

  [[nodiscard]] Channel& channel() { return channel_; }
  [[nodiscard]] pid_t id() const { return child_.id(); }

  // The oldest message, in place of what `out` had; false: there is none, or the memory is damaged, which look() finds.
  bool receive(std::vector<std::byte>& out);
  // As Channel::wait(), at most until the next look is due.
  void wait(Nanoseconds timeout, int also);
  // Is due each kLookEvery; costs nothing in between. Why the process has to be replaced, in words that begin with what
  // happened to it ("was ended by signal 6 (SIGABRT)"); it has ended then. None: it runs.
  [[nodiscard]] std::optional<std::string> look(Timestamp now);
  // Ends it; what look() would have said goes first, if it has ended by itself.
  [[nodiscard]] std::string end(const std::string& why);

 private:
  SandboxProcess(Channel channel, ChildProcess child, const SandboxConfig& config,
                 std::shared_ptr<SandboxRecord> record);
  [[nodiscard]] std::optional<std::string> found(Timestamp now);
  [[nodiscard]] std::string why_it_left();
  [[nodiscard]] std::optional<std::string> loops(double messages_per_second);
  [[nodiscard]] std::optional<std::string> floods(Timestamp now);

  Channel channel_;
  ChildProcess child_;
  std::uint64_t memory_limit_;
  double most_fruitless_s_;
  std::shared_ptr<SandboxRecord> record_;
  Timestamp next_look_;
  std::uint64_t last_beats_ = 0;
  int silent_looks_ = 0;
  double processor_s_ = 0;  // that it had taken at the last count
  double fruitless_s_ = 0;
  Timestamp counted_since_;
  std::uint64_t messages_ = 0;  // since then
  std::uint64_t wakes_ = 0;     // likewise
};

}  // namespace cellmirror
