// A confined process that is always there: started, watched, and replaced when it ends, at a bounded rate, by a thread
// of its own. Not for the loop.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "ipc/sandbox/restart_delay.hpp"
#include "ipc/sandbox/sandbox_process.hpp"
#include "ipc/sandbox/sandbox_report.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror {

// What is done with it; all by the sandbox's thread, but for stop() and start().
struct SandboxEvents {
  // A process was started and knows nothing yet: what it needs is sent here.
  std::function<void()> started;
  // False: the message is not one that it may send. It is ended and replaced.
  std::function<bool(std::span<const std::byte> message)> received;
  // It has ended; `why` as SandboxProcess::look() says it.
  std::function<void(const std::string& why)> ended;
  // stop() was called: what makes the process end by itself is sent here. It is ended where it takes longer than
  // Sandbox::kFarewell.
  std::function<void()> stopping;
};

class Sandbox {
 public:
  static constexpr Nanoseconds kFarewell{500'000'000};

  // `thread_name`: at most 15 characters.
  Sandbox(SandboxConfig config, SandboxEvents events, std::string thread_name);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  // Fails where the program cannot be started at all. Once.
  [[nodiscard]] Result<void> start();
  // Ends the process and the thread; no event after it returns. Not called from an event.
  void stop();

  // A message that is `head` and then `body`. Does not wait; false where there is no process, or no room because the
  // process does not read. Any thread.
  bool send(std::span<const std::byte> head, std::span<const std::byte> body = {});
  [[nodiscard]] SandboxReport report() const { return record_->report(); }
  // Why there is no process now, as a sentence about it; empty while there is one. Any thread.
  [[nodiscard]] std::string outage() const;

 private:
  void run();
  void serve();
  void say_farewell();
  // False: one that may not come. `some`: there were some.
  [[nodiscard]] bool take_messages(bool& some);
  [[nodiscard]] bool launch();
  void pause_until(Timestamp when);
  void note_end(const std::string& why);

  const SandboxConfig config_;
  const SandboxEvents events_;
  const std::string thread_name_;
  SystemClock clock_;
  WakeSignal wake_;
  std::atomic<bool> stop_{false};
  std::shared_ptr<SandboxRecord> record_;
  RestartDelay delay_;              // the thread's, as what follows
  std::vector<std::byte> message_;  // reused
  Timestamp last_woken_;
  std::optional<Error> first_failure_;
  mutable std::mutex mutex_;                 // of what follows
  std::shared_ptr<SandboxProcess> process_;  // null: there is none now
  std::string outage_;
  std::mutex start_mutex_;
  std::condition_variable first_try_;
  bool first_try_done_ = false;
  std::thread thread_;
};

}  // namespace cellmirror
