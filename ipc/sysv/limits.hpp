// What this machine allows of System V queues, for `cellmirror doctor`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// The kernel's limits of this IPC namespace; 0 where unreadable.
struct SysvLimits {
  std::uint64_t max_message_bytes = 0;  // msgmax
  std::uint64_t max_queue_bytes = 0;    // msgmnb, of a new queue
  std::uint64_t max_queues = 0;         // msgmni
  std::uint64_t queues_in_use = 0;
};
[[nodiscard]] SysvLimits read_sysv_limits(const std::filesystem::path& root = "/");

// logind removes the queues and shared memory of an ordinary user when the last session of that user ends, unless
// RemoveIPC=no (logind.conf(5)). Root and system users are exempt.
struct RemoveIpc {
  bool logind_runs = false;
  bool enabled = true;       // the setting; logind's default is yes
  std::string set_by;        // the file that says so; empty for the default
  bool concerns_us = false;  // enabled, logind runs, and this user is an ordinary one
};
[[nodiscard]] RemoveIpc read_remove_ipc(const std::filesystem::path& root = "/");

// One fact for a person.
struct IpcFinding {
  std::string name;   // "msgmax", "RemoveIPC"
  std::string value;  // "8192 bytes", "yes (default)"
  bool ok = true;
  std::string remedy;  // a command; empty where ok
};
[[nodiscard]] std::vector<IpcFinding> ipc_findings(const SysvLimits& limits, const RemoveIpc& remove_ipc);

}  // namespace cellmirror
