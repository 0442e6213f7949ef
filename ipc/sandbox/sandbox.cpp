#include "ipc/sandbox/sandbox.hpp"

#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror {

namespace {

constexpr int kMessagesPerRound = 4096;  // between two checks of the process and of stop()
// If two wake-ups are less than kBusyGap apart, the thread collects messages every kCollect and asks for a wake-up only
// after an empty round: a wake-up for each message would cost more processor time than the message.
constexpr Nanoseconds kBusyGap{500'000};
constexpr timespec kCollect{0, 400'000};

}  // namespace

Sandbox::Sandbox(SandboxConfig config, SandboxEvents events, std::string thread_name)
    : config_(std::move(config)),
      events_(std::move(events)),
      thread_name_(std::move(thread_name)),
      record_(SandboxRecord::make(config_.program, config_.subject, config_.memory_bytes, config_.consequence)) {}

Sandbox::~Sandbox() { stop(); }

Result<void> Sandbox::start() {
  CELLMIRROR_EXPECTS(!thread_.joinable());
  thread_ = std::thread([this] { run(); });
  std::unique_lock lock(start_mutex_);
  first_try_.wait(lock, [this] { return first_try_done_; });
  if (!first_failure_) return {};
  const Error failure = *first_failure_;
  lock.unlock();
  stop();
  return std::unexpected(failure);
}

void Sandbox::stop() {
  if (!thread_.joinable()) return;
  stop_.store(true);
  wake_.wake();
  thread_.join();
}

bool Sandbox::send(std::span<const std::byte> head, std::span<const std::byte> body) {
  std::shared_ptr<SandboxProcess> process;
  {
    const std::scoped_lock lock(mutex_);
    process = process_;
  }
  return process && process->channel().send(head, body);
}

std::string Sandbox::outage() const {
  const std::scoped_lock lock(mutex_);
  return outage_;
}

bool Sandbox::launch() {
  auto started = SandboxProcess::start(config_, record_);
  const std::optional<Error> failure = started ? std::nullopt : std::optional(started.error());
  if (started) {
    const std::scoped_lock lock(mutex_);
    process_ = std::move(*started);
    outage_.clear();
  }
  {
    const std::scoped_lock lock(start_mutex_);
    if (!first_try_done_) first_failure_ = failure;
    first_try_done_ = true;
  }
  first_try_.notify_all();
  if (failure) note_end(failure->what);
  return !failure;
}

void Sandbox::run() {
  set_thread_name(thread_name_);
  while (!stop_.load()) {
    if (launch()) {
      if (events_.started) events_.started();
      serve();
    }
    if (stop_.load()) break;
    const Timestamp now = clock_.now();
    const Nanoseconds delay = delay_.after_end(now);
    log_warning("sandbox", "{} ({}) {}; it starts again in {:.1f} s (restart {})", config_.program, config_.subject,
                record_->report().last_exit, seconds(delay), record_->report().restarts);
    pause_until(now + delay);
  }
}

void Sandbox::pause_until(Timestamp when) {
  for (Timestamp now = clock_.now(); now < when && !stop_.load(); now = clock_.now()) wake_.wait(when - now);
}

void Sandbox::serve() {
  while (!stop_.load()) {
    process_->wait(SandboxProcess::kCheckEvery, wake_.descriptor());
    const Timestamp now = clock_.now();
    const bool busy = now - last_woken_ < kBusyGap;
    last_woken_ = now;
    bool more = false;
    do {
      if (busy) nanosleep(&kCollect, nullptr);
      std::optional<std::string> why;
      if (!take_messages(more)) why = process_->end("sent a message that it may not send");
      if (!why) why = process_->check(clock_.now());
      if (why) return note_end(*why);
    } while (busy && more && !stop_.load());
  }
  say_farewell();
  record_->stopped();
  const std::scoped_lock lock(mutex_);
  process_.reset();
}

void Sandbox::say_farewell() {
  if (events_.stopping) {
    events_.stopping();
    const Timestamp until = clock_.now() + kFarewell;
    bool some = false;
    while (clock_.now() < until && !process_->channel().ended() && take_messages(some))
      process_->wait(until - clock_.now(), -1);
  }
  static_cast<void>(process_->end("was stopped"));
}

bool Sandbox::take_messages(bool& some) {
  some = false;
  for (int i = 0; i < kMessagesPerRound && process_->receive(message_); ++i) {
    some = true;
    if (!events_.received(message_)) return false;
  }
  return true;
}

void Sandbox::note_end(const std::string& why) {
  record_->ended(why, true);
  {
    const std::scoped_lock lock(mutex_);
    process_.reset();
    outage_ = fmt::format("{} {}", config_.program, why);
  }
  if (events_.ended) events_.ended(why);
}

}  // namespace cellmirror
