#include "ipc/sysv/script_message_receiver.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "ipc/sysv/owned_queue.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kErrorsKept = 16;
// How many old replies one reply may push out: the longest has the room of a thousand of the shortest.
constexpr int kMostPushedOut = 1100;
constexpr std::chrono::seconds kBetweenRepairs{1};
constexpr std::chrono::milliseconds kBetweenLooks{200};

// None where it has ended already.
std::optional<std::uint32_t> user_of_process(std::int32_t process) {
  struct stat folder{};
  if (process <= 0 || ::stat(fmt::format("/proc/{}", process).c_str(), &folder) != 0) return std::nullopt;
  return folder.st_uid;
}

}  // namespace

struct ScriptMessageReceiver::Impl {
  QueueConfig config;
  std::string instance;
  Handler handler;
  RefusedHandler refused;
  std::unique_ptr<OwnedQueue> input;
  std::unique_ptr<OwnedQueue> replies_queue;
  std::thread thread;
  std::thread watch;

  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> malformed{0};
  std::atomic<std::uint64_t> wrong_type{0};
  std::atomic<std::uint64_t> replies{0};
  std::atomic<std::uint64_t> replies_dropped{0};

  mutable std::mutex mutex;  // queues against stop(), and what follows
  std::condition_variable stopping;
  bool running = false;
  std::deque<std::string> last_errors;
  std::mutex reply_mutex;  // one reply at a time, so that two full-queue repairs do not push each other out

  void note_error(std::string text) {
    const std::lock_guard guard(mutex);
    last_errors.push_back(std::move(text));
    if (last_errors.size() > kErrorsKept) last_errors.pop_front();
  }

  void receive_until_closed();
  void take(long type, std::span<const char> text);
  bool repair(OwnedQueue& queue);
  void pause(std::chrono::milliseconds time);  // ends early at stop()
  void watch_queues();
  void send_reply(std::int64_t tag, const ScriptReply& reply);
};

void ScriptMessageReceiver::Impl::receive_until_closed() {
  // One byte more than allowed shows that a message was longer.
  std::array<char, kMaxScriptMessageBytes + 1> buffer;
  while (!input->closed()) {
    long type = 0;
    std::size_t length = 0;
    const QueueOutcome outcome = input->receive(type, buffer, length);
    if (outcome == QueueOutcome::done) {
      take(type, std::span<const char>(buffer).first(length));
    } else if (!input->closed()) {
      const bool repaired = repair(*input);
      repair(*replies_queue);  // log-out removes both
      if (!repaired || outcome == QueueOutcome::failed) pause(kBetweenRepairs);
    }
  }
}

void ScriptMessageReceiver::Impl::take(long type, std::span<const char> text) {
  if (type != kScriptMessageType) {
    wrong_type.fetch_add(1, std::memory_order_relaxed);
    log_warning("ipc.wrong-type", "a message of type {} on the SCRIPT queue was discarded; commands have type {}", type,
                kScriptMessageType);
    return;
  }
  const std::int32_t sender = input->last_sender();
  const auto user = user_of_process(sender);
  ScriptEnvelope envelope = parse_script_message(text);
  // A reply queue that is missing must be back before the sender may count on the reply.
  if (envelope.tag != 0) repair(*replies_queue);
  if (!envelope.text) {
    malformed.fetch_add(1, std::memory_order_relaxed);
    const std::string why = envelope.text.error().text();
    note_error(fmt::format("message from process {}: {}", sender, why));
    log_warning("ipc.malformed-message", "from process {}: {}", sender, why);
    if (refused) refused({{}, envelope.tag, sender, user}, why);
    send_reply(envelope.tag, {false, why});
    return;
  }
  received.fetch_add(1, std::memory_order_relaxed);
  handler({std::move(*envelope.text), envelope.tag, sender, user});
}

// Reports each state once, however often it is called. Any thread.
bool ScriptMessageReceiver::Impl::repair(OwnedQueue& queue) {
  const std::uint64_t before = queue.recreated();
  const std::string problem_before = queue.problem();
  const auto made = queue.recreate();
  if (made) {
    if (queue.recreated() != before) {
      log_warning("ipc.queue-removed", "the {} queue {} was removed by another program and is recreated",
                  queue.options().purpose, key_text(queue.options().key));
    }
    return true;
  }
  if (queue.closed() || made.error().text() == problem_before) return false;
  note_error(made.error().text());
  log_error("ipc.queue-lost", "{}; it is tried again until it succeeds", made.error().text());
  return false;
}

void ScriptMessageReceiver::Impl::pause(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex);
  stopping.wait_for(lock, time, [this] { return !running; });
}

// A client opens the reply queue before it sends: without it, no message comes that would bring it back.
void ScriptMessageReceiver::Impl::watch_queues() {
  while (!replies_queue->closed() && !input->closed()) {
    pause(kBetweenLooks);
    repair(*replies_queue);
    repair(*input);
  }
}

void ScriptMessageReceiver::Impl::send_reply(std::int64_t tag, const ScriptReply& reply) {
  if (tag == 0) return;
  const std::lock_guard guard(reply_mutex);
  const std::string text = reply_text(reply);
  int pushed_out = 0;
  bool repaired = false;
  while (true) {
    const QueueOutcome outcome = replies_queue->send_now(static_cast<long>(tag), text);
    if (outcome == QueueOutcome::done) {
      replies.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (outcome == QueueOutcome::full && pushed_out < kMostPushedOut &&
        replies_queue->discard_oldest(0) == QueueOutcome::done) {
      ++pushed_out;
      replies_dropped.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    if (outcome == QueueOutcome::gone && !repaired && replies_queue->recreate()) {
      repaired = true;
      continue;
    }
    replies_dropped.fetch_add(1, std::memory_order_relaxed);
    return;
  }
}

ScriptMessageReceiver::ScriptMessageReceiver(QueueConfig config, std::string instance)
    : impl_(std::make_unique<Impl>()) {
  impl_->config = config;
  impl_->instance = std::move(instance);
}

ScriptMessageReceiver::~ScriptMessageReceiver() { stop(); }

Result<void> ScriptMessageReceiver::start(Handler handler, RefusedHandler refused) {
  CELLMIRROR_EXPECTS(!impl_->thread.joinable() && handler);
  // The reply queue first: a sender that sees the input queue finds the reply queue too.
  auto replies = OwnedQueue::make({"SCRIPT reply", impl_->config.reply_key, impl_->config.mode, impl_->instance});
  if (!replies) return std::unexpected(replies.error());
  auto input = OwnedQueue::make({"SCRIPT input", impl_->config.script_key, impl_->config.mode, impl_->instance});
  if (!input) return std::unexpected(input.error());
  if ((*input)->discarded() > 0) {
    log_warning("ipc.left-behind", "{} messages left by an earlier process in queue {} were discarded",
                (*input)->discarded(), key_text(impl_->config.script_key));
  }
  {
    const std::scoped_lock guard(impl_->mutex, impl_->reply_mutex);
    impl_->input = std::move(*input);
    impl_->replies_queue = std::move(*replies);
    impl_->handler = std::move(handler);
    impl_->refused = std::move(refused);
    impl_->running = true;
  }
  try {
    impl_->thread = std::thread([this] {
      ::pthread_setname_np(::pthread_self(), "script-queue");
      impl_->receive_until_closed();
    });
    impl_->watch = std::thread([this] {
      ::pthread_setname_np(::pthread_self(), "queue-watch");
      impl_->watch_queues();
    });
  } catch (const std::system_error& error) {
    impl_->input->close();
    impl_->replies_queue->close();
    if (impl_->thread.joinable()) impl_->thread.join();
    return fail(fmt::format("cannot start the thread of the SCRIPT queue: {}", error.what()),
                "raise the limit of processes");
  }
  return {};
}

void ScriptMessageReceiver::stop() {
  if (!impl_->thread.joinable()) return;
  {
    const std::lock_guard guard(impl_->mutex);
    impl_->running = false;
  }
  impl_->input->close();  // ends the wait in the kernel
  impl_->stopping.notify_all();
  impl_->thread.join();
  impl_->watch.join();
  const std::lock_guard guard(impl_->reply_mutex);
  impl_->replies_queue->close();
}

void ScriptMessageReceiver::reply(std::int64_t tag, const ScriptReply& reply) {
  {
    const std::lock_guard guard(impl_->mutex);
    if (!impl_->running) return;
  }
  impl_->send_reply(tag, reply);
}

ScriptMessageStatus ScriptMessageReceiver::status() const {
  ScriptMessageStatus status;
  status.received = impl_->received.load(std::memory_order_relaxed);
  status.malformed = impl_->malformed.load(std::memory_order_relaxed);
  status.wrong_type = impl_->wrong_type.load(std::memory_order_relaxed);
  status.replies = impl_->replies.load(std::memory_order_relaxed);
  status.replies_dropped = impl_->replies_dropped.load(std::memory_order_relaxed);
  const std::lock_guard guard(impl_->mutex);
  status.last_errors.assign(impl_->last_errors.begin(), impl_->last_errors.end());
  if (impl_->input) {
    status.recreated = impl_->input->recreated() + impl_->replies_queue->recreated();
    status.discarded = impl_->input->discarded();
    status.waiting = impl_->input->waiting();
    status.input_problem = impl_->input->problem();
    status.reply_problem = impl_->replies_queue->problem();
    status.input_queue = impl_->input->id();
    status.reply_queue = impl_->replies_queue->id();
  }
  return status;
}

}  // namespace cellmirror
