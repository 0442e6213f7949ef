// The sender's side of the acknowledged form: what `cellmirror send` does.
#pragma once

#include <cstdint>
#include <string_view>

#include "ipc/wire/script_message.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

// The kernel's number of the queue with that key; -1: there is none.
[[nodiscard]] std::int32_t queue_number(std::int32_t key);

// Sends one command to the gateway that owns `queues.script_key` and waits for its reply. A refusal by the gateway is a
// reply (done == false); failures, each with its remedy, are: no gateway, no permission, a queue that stays full, no
// answer in time (the command may still be executed), a gateway that ended meanwhile.
// `queue`: the kernel's number of the gateway's queue, -1 where it is not known. Nothing is sent into another one.
// Waits in the kernel, guarded by a timer of this thread; it uses the signal SIGRTMAX-1 and puts everything back. One
// call at a time in a process.
[[nodiscard]] Result<ScriptReply> send_command(const QueueConfig& queues, std::string_view command, Nanoseconds timeout,
                                               std::int32_t queue = -1);

}  // namespace cellmirror
