// SCRIPT messages and replies: what is accepted is clean, bounded, and read back the same.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "ipc/wire/script_message.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/utf8.hpp"

namespace {

bool clean(std::string_view text) {
  while (!text.empty()) {
    const auto character = cellmirror::utf8_character(text);
    if (!character || character->code == 0 || character->code == 0x1B || character->code == 0x7F) return false;
    text.remove_prefix(character->bytes);
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const std::span<const char> message(reinterpret_cast<const char*>(data), size);
  const ScriptEnvelope envelope = parse_script_message(message);
  CELLMIRROR_EXPECTS(envelope.tag >= 0 && envelope.tag <= kMaxReplyTag);
  if (envelope.text) {
    CELLMIRROR_EXPECTS(!envelope.text->empty() && envelope.text->size() <= kMaxScriptMessageBytes);
    CELLMIRROR_EXPECTS(clean(*envelope.text));
    // Under a tag of its own: a command may itself begin with @.
    const ScriptEnvelope again = parse_script_message(script_message_text(1, *envelope.text));
    CELLMIRROR_EXPECTS(again.text ? *again.text == *envelope.text : envelope.text->size() + 3 > kMaxScriptMessageBytes);
  } else {
    CELLMIRROR_EXPECTS(!envelope.text.error().what.empty());
  }
  const std::string reply = reply_text({true, std::string(message.begin(), message.end())});
  CELLMIRROR_EXPECTS(reply.size() <= kMaxReplyBytes && clean(reply) && parse_reply(reply));
  if (const auto parsed = parse_reply(message); parsed && clean(parsed->text)) {
    CELLMIRROR_EXPECTS(parse_reply(reply_text(*parsed)).has_value());
  }
  return 0;
}
