// The answer to the request "queues": which System V queues are the gateway's at this moment.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// A client compares the numbers with those that it finds by key: where they differ, another program has taken the key,
// and nothing may be sent there.
struct QueueAnswer {
  std::int32_t script_queue = -1;  // the kernel's number; -1: unknown
  std::int32_t reply_queue = -1;
  std::string script_problem;  // why the key's queue is not the gateway's, with the remedy; empty: it is
  std::string reply_problem;
};

// {"script_queue": 3, "script_problem": "", "reply_queue": 2, "reply_problem": ""}
[[nodiscard]] std::string queue_answer_text(const QueueAnswer& answer);
[[nodiscard]] Result<QueueAnswer> parse_queue_answer(std::string_view text);

}  // namespace cellmirror
