#include "ipc/sysv/script_client.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <string>

#include "ipc/runtime/system_error.hpp"
#include "ipc/sysv/key_lock.hpp"

namespace cellmirror {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Interrupts system calls of this thread from `after` on, again and again: the first signal may come just before a call
// starts to wait, and would be lost alone.
class Interrupter {
 public:
  explicit Interrupter(Nanoseconds after) : signal_(SIGRTMAX - 1) {
    struct sigaction action{};
    action.sa_handler = [](int) {};  // without SA_RESTART, so that calls end with EINTR
    sigemptyset(&action.sa_mask);
    ::sigaction(signal_, &action, &action_before_);
    sigset_t mine;
    sigemptyset(&mine);
    sigaddset(&mine, signal_);
    ::pthread_sigmask(SIG_UNBLOCK, &mine, &mask_before_);

    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = signal_;
    event._sigev_un._tid = ::gettid();  // the C library gives this field no public name
    armed_ = ::timer_create(CLOCK_MONOTONIC, &event, &timer_) == 0;
    const auto first = std::max(after, Nanoseconds{1});
    itimerspec spec{};
    spec.it_value = {first.count() / 1'000'000'000, first.count() % 1'000'000'000};
    spec.it_interval = {0, 20'000'000};
    if (armed_) ::timer_settime(timer_, 0, &spec, nullptr);
  }
  ~Interrupter() {
    if (armed_) ::timer_delete(timer_);
    ::pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
    ::sigaction(signal_, &action_before_, nullptr);
  }
  Interrupter(const Interrupter&) = delete;
  Interrupter& operator=(const Interrupter&) = delete;
  [[nodiscard]] bool armed() const { return armed_; }

 private:
  int signal_;
  bool armed_ = false;
  timer_t timer_{};
  struct sigaction action_before_{};
  sigset_t mask_before_{};
};

// Random, so that a reply to an ended program reaches no other; above the numbers of processes, which simple clients
// take for their tags.
std::int64_t new_tag() {
  constexpr std::uint32_t kLargestPid = 4'194'304;  // PID_MAX_LIMIT
  std::uint32_t random = 0;
  if (::getrandom(&random, sizeof random, 0) != static_cast<ssize_t>(sizeof random)) {
    random = static_cast<std::uint32_t>(::getpid()) * 2'654'435'761u;
  }
  return kLargestPid + 1 + random % (static_cast<std::uint32_t>(kMaxReplyTag) - kLargestPid);
}

struct CommandBuffer {
  long type;
  std::array<char, kMaxScriptMessageBytes> text;
};

std::string seconds_text(Nanoseconds timeout) { return fmt::format("{:g} s", seconds(timeout)); }

std::unexpected<Error> no_gateway(std::int32_t key) {
  return fail(fmt::format("no gateway is running: there is no message queue with the key {}", key_text(key)),
              "start one with cellmirror run CELL.toml");
}

std::unexpected<Error> queue_failure(std::int32_t key, int error_number) {
  switch (error_number) {
    case ENOENT:
      return no_gateway(key);
    case EACCES:
    case EPERM:
      return fail(fmt::format("the message queue {} belongs to another user", key_text(key)),
                  "run this as the user of the gateway, or set a wider mode in the cell file");
    case EIDRM:
    case EINVAL:
      return fail("the gateway ended before it answered", "see its log, and start it with cellmirror run CELL.toml");
    default:
      return fail(fmt::format("message queue {}: {}", key_text(key), system_error_text(error_number)));
  }
}

std::unexpected<Error> queue_of_another(std::int32_t key) {
  return fail(fmt::format("the message queue {} is not the gateway's: another program has created it", key_text(key)),
              "cellmirror status shows more; end that program, or set other keys in the cell file");
}

class Exchange {
 public:
  Exchange(const QueueConfig& queues, Nanoseconds timeout, std::int32_t queue)
      : queues_(queues),
        queue_(queue),
        timeout_(timeout),
        deadline_(SteadyClock::now() + timeout),
        interrupter_(timeout) {}

  Result<ScriptReply> run(std::string_view command) {
    if (!interrupter_.armed())
      return fail("no timer is available for the time-out", "raise the limit of pending signals");
    const int input = ::msgget(queues_.script_key, 0200);
    if (input < 0) return queue_failure(queues_.script_key, errno);
    if (queue_ >= 0 && input != queue_) return queue_of_another(queues_.script_key);
    const std::int64_t tag = new_tag();
    const std::string text = script_message_text(tag, command);
    if (text.size() > kMaxScriptMessageBytes) {
      return fail(fmt::format("the command is longer than {} bytes", kMaxScriptMessageBytes),
                  "put it into a script file and send EXEC_SCRIPT");
    }
    if (const auto sent = send(input, text); !sent) return std::unexpected(sent.error());
    return receive(tag);
  }

 private:
  [[nodiscard]] bool in_time() const { return SteadyClock::now() < deadline_; }

  Result<void> send(int queue, std::string_view text) {
    CommandBuffer message;
    message.type = kScriptMessageType;
    std::copy(text.begin(), text.end(), message.text.begin());
    while (::msgsnd(queue, &message, text.size(), 0) != 0) {
      if (errno != EINTR) return queue_failure(queues_.script_key, errno);
      if (!in_time()) {
        return fail(fmt::format("the message queue {} stayed full for {}, the command was not sent",
                                key_text(queues_.script_key), seconds_text(timeout_)) +
                        holder_text(),
                    "check with cellmirror status what keeps the gateway busy");
      }
    }
    return {};
  }

  // Opened after sending: a gateway with a removed reply queue recreates it for a message that requests a reply.
  Result<int> reply_queue() {
    while (true) {
      const int id = ::msgget(queues_.reply_key, 0400);
      if (id >= 0) return id;
      const int reason = errno;
      if (reason != ENOENT || !in_time()) return queue_failure(queues_.reply_key, reason);
      const timespec pause{0, 1'000'000};
      ::nanosleep(&pause, nullptr);
    }
  }

  Result<ScriptReply> receive(std::int64_t tag) {
    const auto queue = reply_queue();
    if (!queue) return std::unexpected(queue.error());
    CommandBuffer message;
    ssize_t length = 0;
    while ((length = ::msgrcv(*queue, &message, message.text.size(), static_cast<long>(tag), MSG_NOERROR)) < 0) {
      if (errno != EINTR) return queue_failure(queues_.reply_key, errno);
      if (!in_time()) {
        return fail(fmt::format("the gateway did not answer within {}{}; the command may still be executed",
                                seconds_text(timeout_), holder_text()),
                    "check its activity with cellmirror status, or wait longer with --timeout");
      }
    }
    return parse_reply(std::span<const char>(message.text).first(static_cast<std::size_t>(length)));
  }

  // A gateway that was killed leaves its queue behind.
  [[nodiscard]] std::string holder_text() const {
    return KeyLock::is_held(queues_.script_key) ? "" : " (no gateway of this user holds the queue)";
  }

  QueueConfig queues_;
  std::int32_t queue_;
  Nanoseconds timeout_;
  SteadyClock::time_point deadline_;
  Interrupter interrupter_;
};

}  // namespace

std::int32_t queue_number(std::int32_t key) { return ::msgget(key, 0); }

Result<ScriptReply> send_command(const QueueConfig& queues, std::string_view command, Nanoseconds timeout,
                                 std::int32_t queue) {
  return Exchange(queues, timeout, queue).run(command);
}

}  // namespace cellmirror
