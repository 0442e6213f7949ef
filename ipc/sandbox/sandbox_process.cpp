#include "ipc/sandbox/sandbox_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include "ipc/sandbox/confinement.hpp"

namespace cellmirror {

namespace {

constexpr std::uint64_t kMega = 1ULL << 20U;
// Freed blocks in quarantine and the shadow memory of sanitizers count as resident memory.
#if defined(CELLMIRROR_SANITIZED)
constexpr std::uint64_t kOfSanitizers = 4;
#else
constexpr std::uint64_t kOfSanitizers = 1;
#endif

std::string ran_out_of_memory(std::uint64_t limit) {
  return fmt::format("reached its memory limit of {} MB", limit / kMega);
}

// `status`: from waitpid().
std::string in_words(int status, std::uint64_t memory_limit) {
  if (WIFSTOPPED(status)) return fmt::format("was stopped by signal {}", signal_text(WSTOPSIG(status)));
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", signal_text(WTERMSIG(status)));
  if (WEXITSTATUS(status) == kOutOfMemoryStatus) return ran_out_of_memory(memory_limit);
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

// Resident memory; 0 if it is not known.
std::uint64_t resident_bytes(pid_t pid) {
  const Descriptor file(open(fmt::format("/proc/{}/statm", pid).c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) return 0;
  std::array<char, 128> text{};
  if (read(file.get(), text.data(), text.size() - 1) <= 0) return 0;
  const char* second = std::strchr(text.data(), ' ');
  if (second == nullptr) return 0;
  return std::strtoull(second, nullptr, 10) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// Processor time of all threads, s; 0 if it is not known. Source: proc(5), /proc/pid/stat.
double processor_seconds(pid_t pid) {
  const Descriptor file(open(fmt::format("/proc/{}/stat", pid).c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) return 0;
  std::array<char, 1024> text{};
  if (read(file.get(), text.data(), text.size() - 1) <= 0) return 0;
  const char* after_name = std::strrchr(text.data(), ')');
  unsigned long user = 0;
  unsigned long system = 0;
  if (after_name == nullptr ||
      std::sscanf(after_name + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &system) != 2)
    return 0;
  return static_cast<double>(user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

SandboxProcess::SandboxProcess(Channel channel, ChildProcess child, const SandboxConfig& config,
                               std::shared_ptr<SandboxRecord> record)
    : channel_(std::move(channel)),
      child_(std::move(child)),
      memory_limit_(config.memory_bytes),
      most_fruitless_s_(config.most_fruitless_s),
      record_(std::move(record)) {}

Result<std::unique_ptr<SandboxProcess>> SandboxProcess::start(const SandboxConfig& config,
                                                              std::shared_ptr<SandboxRecord> record) {
  auto ends = Channel::make(config.channel);
  if (!ends) return std::unexpected(ends.error());
  auto child = start_on_channel(program_beside_this(config.program), config.subject, ends->child_socket, ends->memory);
  if (!child) return std::unexpected(child.error());
  record->started(child->id());
  return std::unique_ptr<SandboxProcess>(
      new SandboxProcess(std::move(ends->owner), std::move(*child), config, std::move(record)));
}

bool SandboxProcess::receive(std::vector<std::byte>& out) {
  if (channel_.receive(out) != RingResult::done) return false;
  ++messages_;
  return true;
}

void SandboxProcess::wait(Nanoseconds timeout, int also) {
  pollfd other{also, POLLIN, 0};
  channel_.wait(std::min(timeout, kCheckEvery), std::span(&other, also < 0 ? 0 : 1));
  wakes_ += channel_.wakes();
  if (channel_.ended()) next_check_ = {};
}

std::optional<std::string> SandboxProcess::flood(Timestamp now) {
  constexpr Nanoseconds kOver{1'000'000'000};
  if (!counted_since_.known()) counted_since_ = now;
  const Nanoseconds since = now - counted_since_;
  if (since < kOver) return std::nullopt;
  const double per_second = 1.0 / seconds(since);
  const double messages = static_cast<double>(std::exchange(messages_, 0)) * per_second;
  const double wakes = static_cast<double>(std::exchange(wakes_, 0)) * per_second;
  counted_since_ = now;
  if (messages > static_cast<double>(kMostMessagesPerSecond))
    return fmt::format("flooded cellmirror with {:.0f} messages per second", messages);
  if (wakes > messages + static_cast<double>(kMostIdleWakesPerSecond))
    return fmt::format("woke cellmirror {:.0f} times per second for nothing", wakes);
  return fruitless(messages);
}

std::optional<std::string> SandboxProcess::fruitless(double messages_per_second) {
  constexpr double kRests = 0.3;     // share of a processor; on a busy machine an endless loop gets no more
  constexpr double kQuiet = 1000.0;  // messages per second; a busy network brings more
  const double taken = processor_seconds(child_.id());
  const double used = taken - std::exchange(processor_s_, taken);
  fruitless_s_ = used > kRests && messages_per_second < kQuiet ? fruitless_s_ + used : 0;
  if (fruitless_s_ < most_fruitless_s_) return std::nullopt;
  return fmt::format("computed for {:.0f} s without a result", fruitless_s_);
}

std::optional<std::string> SandboxProcess::fault(Timestamp now) {
  if (channel_.damaged()) return "damaged the memory that it shares with cellmirror";
  if (const auto status = child_.changed()) return in_words(*status, memory_limit_);
  if (channel_.ended()) return reason_of_exit();
  const std::uint64_t beats = channel_.beats();
  silent_checks_ = beats == std::exchange(last_beats_, beats) ? silent_checks_ + 1 : 0;
  if (silent_checks_ > kMostSilentChecks)
    return fmt::format("did not answer for {:.1f} s", seconds(kCheckEvery * silent_checks_));
  if (auto flooding = flood(now)) return flooding;
  const std::uint64_t memory = resident_bytes(child_.id());
  record_->measured(memory, channel_.confinement());
  if (memory > memory_limit_ * kOfSanitizers) return ran_out_of_memory(memory_limit_);
  return std::nullopt;
}

std::optional<std::string> SandboxProcess::check(Timestamp now) {
  if (next_check_.known() && now < next_check_) return std::nullopt;
  next_check_ = now + kCheckEvery;
  auto why = fault(now);
  if (why) return end(*why);
  return std::nullopt;
}

// A process that ends closes its descriptors before waitpid() returns its status.
std::string SandboxProcess::reason_of_exit() {
  constexpr int kTries = 20;
  constexpr timespec kPause{0, 5'000'000};
  for (int i = 0; i < kTries; ++i) {
    if (const auto status = child_.changed()) return in_words(*status, memory_limit_);
    nanosleep(&kPause, nullptr);
  }
  return "closed its connection to cellmirror";
}

std::string SandboxProcess::end(const std::string& why) {
  const auto status = child_.changed();
  const bool by_itself = status && !WIFSTOPPED(*status);
  child_.end();
  return by_itself ? in_words(*status, memory_limit_) : why;
}

}  // namespace cellmirror
