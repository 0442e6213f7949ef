// State of the confined processes for status and metrics: memory, restarts, and the reason of the last exit.
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
  std::string program;      // name in lists of processes
  std::string subject;      // e.g. "DDS domain 0 on 127.0.0.1"; unique among those of one program
  std::string consequence;  // of its absence, for problems; empty: not a problem of its own
  SandboxState state = SandboxState::starting;
  pid_t pid = 0;                   // 0 while there is none
  std::uint64_t memory_bytes = 0;  // resident, at the last check
  std::uint64_t memory_limit_bytes = 0;
  ConfinementOutcome confinement;  // of the running process
  std::uint64_t restarts = 0;      // after exits that were not requested
  std::string last_exit;           // reason of the last exit that was not requested; empty: there was none
};

// The report on one process and its replacements. Any thread.
class SandboxRecord {
 public:
  // sandbox_reports() lists the record until it is destroyed.
  [[nodiscard]] static std::shared_ptr<SandboxRecord> make(std::string program, std::string subject,
                                                           std::uint64_t memory_limit_bytes,
                                                           std::string consequence = {});

  [[nodiscard]] SandboxReport report() const;
  void started(pid_t pid);
  void measured(std::uint64_t memory_bytes, const ConfinementOutcome& confinement);
  // `again`: another process replaces it.
  void ended(const std::string& why, bool again);
  // The process has ended on request.
  void stopped();

 private:
  explicit SandboxRecord(SandboxReport report) : report_(std::move(report)) {}

  mutable std::mutex mutex_;
  SandboxReport report_;
};

// Reports in the order in which the records were made.
[[nodiscard]] std::vector<SandboxReport> sandbox_reports();

}  // namespace cellmirror
