// Whose a System V object is: also of those that this process may not look at.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cellmirror {

enum class IpcKind { queue, memory, semaphore };

struct IpcOwner {
  std::int32_t key = 0;
  std::int32_t id = -1;  // the kernel's number, for ipcrm
  uid_t owner = 0;
  uid_t creator = 0;
};

// Of this IPC namespace, by key, from /proc/sysvipc, which shows every object to every user; none: there is no such
// object, or no /proc.
[[nodiscard]] std::optional<IpcOwner> ipc_owner(IpcKind kind, std::int32_t key);
// The same in a text of that form (proc(5)), which begins with a line of headings.
[[nodiscard]] std::optional<IpcOwner> find_ipc_owner(std::string_view table, IpcKind kind, std::int32_t key);

// "user bob (uid 1001)"; "uid 1001" where the user has no name.
[[nodiscard]] std::string user_text(uid_t user);
// "ipcrm -q 3", with -m for memory and -s for a semaphore.
[[nodiscard]] std::string remove_command(IpcKind kind, std::int32_t id);

// A process of that user whose program is cellmirror; 0: none is visible. Reads /proc.
[[nodiscard]] pid_t gateway_process_of(uid_t user);

}  // namespace cellmirror
