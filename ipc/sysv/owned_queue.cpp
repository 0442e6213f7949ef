#include "ipc/sysv/owned_queue.hpp"

#include <fmt/format.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>

#include "ipc/runtime/ipc_owner.hpp"
#include "ipc/runtime/system_error.hpp"
#include "ipc/wire/record.hpp"
#include "ipc/wire/script_message.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kLongest = std::max(kMaxRecordBytes, kMaxScriptMessageBytes) + 1;

struct MessageBuffer {
  long type;
  std::array<char, kLongest> text;
};

std::string queue_text(const OwnedQueue::Options& options) {
  return fmt::format("the {} queue {}", options.purpose, key_text(options.key));
}

std::unexpected<Error> other_users(const OwnedQueue::Options& options, const std::string& detail) {
  const auto found = ipc_owner(IpcKind::queue, options.key);
  const std::string owner = found ? user_text(found->creator) : "another user";
  const std::string changed =
      found && found->owner != found->creator ? fmt::format(", and belongs to {} now", user_text(found->owner)) : "";
  const std::string command =
      found ? remove_command(IpcKind::queue, found->id) : fmt::format("ipcrm -Q {}", options.key);
  return fail(fmt::format("{} was created by another user: {}{}{}", queue_text(options), owner, changed, detail),
              fmt::format("that user or root must run {}, or set other keys under [queues] in the cell file", command));
}

// Whether the queue that is there may be taken for one that an earlier gateway of this user left behind.
Result<void> check_left_behind(const OwnedQueue::Options& options, int id, std::uint64_t& messages) {
  msqid_ds found{};
  if (::msgctl(id, IPC_STAT, &found) != 0) {
    if (errno == EIDRM || errno == EINVAL) return {};  // gone meanwhile
    return other_users(options, "");
  }
  messages = found.msg_qnum;
  if (found.msg_perm.uid != ::geteuid() || found.msg_perm.cuid != ::geteuid()) return other_users(options, "");
  const unsigned mode = found.msg_perm.mode & 0777u;
  if ((mode & ~options.mode) != 0) {
    return fail(
        fmt::format("{} has a wider mode ({:o}) than the cell file allows ({:o}), so another program has created it",
                    queue_text(options), mode, options.mode),
        fmt::format("end that program and run {}, or allow that mode in the cell file",
                    remove_command(IpcKind::queue, id)));
  }
  return {};
}

// Removes what was left behind and makes the queue. A few tries: others may make or remove queues at the same time.
Result<int> make_queue(const OwnedQueue::Options& options, std::uint64_t& discarded) {
  for (int i = 0; i < 8; ++i) {
    const int made = ::msgget(options.key, IPC_CREAT | IPC_EXCL | static_cast<int>(options.mode));
    if (made >= 0) return made;
    if (errno != EEXIST) {
      const int reason = errno;
      return fail(fmt::format("cannot create {}: {}", queue_text(options), system_error_text(reason)),
                  reason == ENOSPC ? "remove unused queues (ipcs -q, ipcrm -q ID) or raise kernel.msgmni" : "");
    }
    const int found = ::msgget(options.key, 0);
    if (found < 0) {
      if (errno == ENOENT) continue;
      return other_users(options, fmt::format(" ({})", system_error_text(errno)));
    }
    std::uint64_t messages = 0;
    if (const auto ours = check_left_behind(options, found, messages); !ours) return std::unexpected(ours.error());
    if (::msgctl(found, IPC_RMID, nullptr) == 0) discarded += messages;
  }
  return fail(fmt::format("{} is repeatedly recreated by another program", queue_text(options)),
              "end that program, or set other keys in the cell file");
}

QueueOutcome outcome_of(int error_number) {
  switch (error_number) {
    case EAGAIN:
      return QueueOutcome::full;
    case ENOMSG:
      return QueueOutcome::empty;
    case EIDRM:
    case EINVAL:  // a removed queue's number is unknown afterwards; lengths and types were checked before
      return QueueOutcome::gone;
    default:
      return QueueOutcome::failed;
  }
}

}  // namespace

Result<std::unique_ptr<OwnedQueue>> OwnedQueue::make(Options options) {
  auto lock = KeyLock::take(options.key, options.instance);
  if (!lock) return std::unexpected(lock.error());
  std::uint64_t discarded = 0;
  const auto id = make_queue(options, discarded);
  if (!id) return std::unexpected(id.error());
  return std::unique_ptr<OwnedQueue>(new OwnedQueue(std::move(options), std::move(*lock), *id, discarded));
}

OwnedQueue::OwnedQueue(Options options, KeyLock lock, int id, std::uint64_t discarded)
    : options_(std::move(options)), lock_(std::move(lock)), id_(id), discarded_(discarded) {}

OwnedQueue::~OwnedQueue() { close(); }

QueueOutcome OwnedQueue::send_now(long type, std::span<const char> text) {
  CELLMIRROR_EXPECTS(type > 0 && text.size() <= kLongest);
  MessageBuffer message;
  message.type = type;
  std::copy(text.begin(), text.end(), message.text.begin());
  while (::msgsnd(id(), &message, text.size(), IPC_NOWAIT) != 0) {
    if (errno != EINTR) return outcome_of(errno);
  }
  return QueueOutcome::done;
}

QueueOutcome OwnedQueue::discard_oldest(long type) {
  MessageBuffer message;
  while (::msgrcv(id(), &message, 0, type, IPC_NOWAIT | MSG_NOERROR) < 0) {
    if (errno != EINTR) return outcome_of(errno);
  }
  return QueueOutcome::done;
}

QueueOutcome OwnedQueue::receive(long& type, std::span<char> text, std::size_t& length) {
  MessageBuffer message;
  const std::size_t most = std::min(text.size(), message.text.size());
  ssize_t got = 0;
  while ((got = ::msgrcv(id(), &message, most, 0, MSG_NOERROR)) < 0) {
    if (errno != EINTR) return outcome_of(errno);
  }
  type = message.type;
  length = static_cast<std::size_t>(got);
  std::copy_n(message.text.begin(), length, text.begin());
  return QueueOutcome::done;
}

Result<void> OwnedQueue::recreate() {
  const std::lock_guard guard(mutex_);
  auto done = try_to_recreate();
  problem_ = done || closed() ? std::string() : done.error().text();
  return done;
}

std::string OwnedQueue::problem() const {
  const std::lock_guard guard(mutex_);
  return problem_;
}

// With the lock.
Result<void> OwnedQueue::try_to_recreate() {
  if (closed()) return fail(fmt::format("{} is closed", queue_text(options_)));
  msqid_ds found{};
  // Another thread may have made it already.
  if (::msgctl(id(), IPC_STAT, &found) == 0) return {};
  if (const auto confirmed = lock_.confirm(); !confirmed) return confirmed;
  std::uint64_t discarded = 0;
  const auto made = make_queue(options_, discarded);
  if (!made) return std::unexpected(made.error());
  id_.store(*made, std::memory_order_release);
  discarded_.fetch_add(discarded, std::memory_order_relaxed);
  recreated_.fetch_add(1, std::memory_order_relaxed);
  return {};
}

void OwnedQueue::close() {
  const std::lock_guard guard(mutex_);
  if (closed_.exchange(true)) return;
  ::msgctl(id(), IPC_RMID, nullptr);
  lock_.release();
}

std::uint64_t OwnedQueue::waiting() const {
  msqid_ds found{};
  return ::msgctl(id(), IPC_STAT, &found) == 0 ? found.msg_qnum : 0;
}

bool OwnedQueue::last_read_by_another() const {
  msqid_ds found{};
  // The time is 0 until the first message is taken out; a process of another PID namespace has the number 0.
  return ::msgctl(id(), IPC_STAT, &found) == 0 && found.msg_rtime != 0 && found.msg_lrpid != ::getpid();
}

std::int32_t OwnedQueue::last_sender() const {
  msqid_ds found{};
  return ::msgctl(id(), IPC_STAT, &found) == 0 ? found.msg_lspid : 0;
}

}  // namespace cellmirror
