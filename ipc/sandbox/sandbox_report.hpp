// What people are shown of the confined processes of this process: their memory, how often they were started again, and
// why the last one ended.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ipc/sandbox/confinement.hpp"

namespace cellmirror {

enum class SandboxState : std::uint8_t { starting, running, restarting, stopped };
[[nodiscard]] const char* words(SandboxState state);

struct SandboxReport {
  std::string program;  // its name in lists of processes
  std::string subject;  // what it does for this process, e.g. "DDS domain 0 on 127.0.0.1"
  SandboxState state = SandboxState::starting;
  pid_t pid = 0;                   // 0: there is none now
  std::uint64_t memory_bytes = 0;  // resident; of the last look, at most about a second ago
  std::uint64_t memory_limit_bytes = 0;
  ConfinementOutcome confinement;  // of the one that runs
  std::uint64_t restarts = 0;      // because one ended that was not to end
  std::string last_exit;           // why the last one ended by itself or was ended; empty: none has
};

// One process and those that take its place, as they are reported. Any thread.
class SandboxRecord {
 public:
  // Listed by sandbox_reports() from now on, until it goes.
  [[nodiscard]] static std::shared_ptr<SandboxRecord> make(std::string program, std::string subject,
                                                           std::uint64_t memory_limit_bytes);

  [[nodiscard]] SandboxReport report() const;
  void started(pid_t pid);
  void measured(std::uint64_t memory_bytes, const ConfinementOutcome& confinement);
  // `again`: another one takes its place.
  void ended(const std::string& why, bool again);
  // It was ended on purpose.
  void stopped();

 private:
  explicit SandboxRecord(SandboxReport report) : report_(std::move(report)) {}

  mutable std::mutex mutex_;
  SandboxReport report_;
};

// In the order in which they were made.
[[nodiscard]] std::vector<SandboxReport> sandbox_reports();

}  // namespace cellmirror
