// The text of messages on the SCRIPT queue (key 2351, type 5) and of the replies to them, as docs/messages.md describes
// them. Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr long kScriptMessageType = 5;                // manual 1.1
inline constexpr std::size_t kMaxScriptMessageBytes = 8192;  // of one message
inline constexpr std::int64_t kMaxReplyTag = 2'147'483'647;  // a message type fits in a 32-bit long
// Longer replies are cut, so that one of them cannot fill the reply queue (16,384 bytes by default).
inline constexpr std::size_t kMaxReplyBytes = 4096;

// Content of a message. A valid `tag` is kept even if the rest is refused, so that the sender gets an answer.
struct ScriptEnvelope {
  std::int64_t tag = 0;      // 1..kMaxReplyTag: message type of the requested reply; 0: none
  Result<std::string> text;  // the command; UTF-8 without control characters but tab and line breaks, never empty
};

// "COMMAND" or "@<tag> COMMAND". The text ends at the first NUL, since C programs send whole buffers; blanks and line
// breaks around it are taken off. Refused, with the place in bytes: no text, a bad tag, bytes that are no UTF-8,
// control characters, more than kMaxScriptMessageBytes.
[[nodiscard]] ScriptEnvelope parse_script_message(std::span<const char> message);

// "@<tag> COMMAND", or COMMAND alone for tag 0.
[[nodiscard]] std::string script_message_text(std::int64_t tag, std::string_view command);

// The answer to a command.
struct ScriptReply {
  bool done = false;
  std::string text;  // the answer of a command, often empty; or the reason of a refusal

  bool operator==(const ScriptReply&) const = default;
};

// "done", "done TEXT" or "refused REASON"; control characters become blanks, cut at kMaxReplyBytes between characters.
[[nodiscard]] std::string reply_text(const ScriptReply& reply);
// Fails for text that is no reply.
[[nodiscard]] Result<ScriptReply> parse_reply(std::span<const char> message);

}  // namespace cellmirror
