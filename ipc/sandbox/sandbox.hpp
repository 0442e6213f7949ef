// Keeps one confined process running: starts it, watches it, and replaces it at a bounded rate when it fails. Uses a
// thread of its own; not for the loop.
//
//   Sandbox sandbox({.program = "cellmirror-dds", ...}, {.started = ..., .received = ...}, "dds");
//   if (auto started = sandbox.start(); !started) return started;
//   sandbox.send(message);
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

// Callbacks, all from the sandbox's thread.
struct SandboxEvents {
  // A new process has started. The callback sends it everything that it needs.
  std::function<void()> started;
  // Returns false for a message that the process may not send; the process is then replaced.
  std::function<bool(std::span<const std::byte> message)> received;
  // The process has ended for the reason `why` (SandboxProcess::check()).
  std::function<void(const std::string& why)> ended;
  // stop() was called. The callback asks the process to end; after Sandbox::kFarewell it is killed.
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

  // Fails if the program cannot be started at all. To be called once.
  [[nodiscard]] Result<void> start();
  // Ends the process and the thread. No callback runs after it returns. Must not be called from a callback.
  void stop();

  // Sends the message `head` + `body` without blocking. Returns false if there is no process, or if the ring is full
  // because the process does not read. Any thread.
  bool send(std::span<const std::byte> head, std::span<const std::byte> body = {});
  [[nodiscard]] SandboxReport report() const { return record_->report(); }
  // "cellmirror-dds was ended by signal 6 (SIGABRT)" while there is no process; empty while one runs. Any thread.
  [[nodiscard]] std::string outage() const;

 private:
  void run();
  void serve();
  void say_farewell();
  // Returns false after a message that the process may not send. `some`: at least one message was there.
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
  RestartDelay delay_;              // used by the thread only, as are the next three
  std::vector<std::byte> message_;  // reused
  Timestamp last_woken_;
  std::optional<Error> first_failure_;
  mutable std::mutex mutex_;                 // guards the next two
  std::shared_ptr<SandboxProcess> process_;  // null while there is none
  std::string outage_;
  std::mutex start_mutex_;
  std::condition_variable first_try_;
  bool first_try_done_ = false;
  std::thread thread_;
};

}  // namespace cellmirror
