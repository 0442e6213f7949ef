#include "ipc/wire/script_message.hpp"

#include <fmt/format.h>

#include <charconv>

#include "rt_core/base/utf8.hpp"

namespace cellmirror {
namespace {

constexpr std::string_view kDone = "done";
constexpr std::string_view kRefused = "refused";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// `before`: bytes of the message in front of `text`, for the place in the error.
Result<std::string> checked_command(std::string_view text, std::size_t before) {
  for (std::size_t at = 0; at < text.size();) {
    const auto character = utf8_character(text.substr(at));
    if (!character) {
      return fail(fmt::format("byte {} of the message is not UTF-8", before + at + 1),
                  "send plain text in ASCII or UTF-8");
    }
    if (is_control_character(character->code) && !is_blank(text[at])) {
      return fail(fmt::format("byte {} of the message is a control character (U+{:04X})", before + at + 1,
                              static_cast<unsigned>(character->code)),
                  "send plain text in ASCII or UTF-8");
    }
    at += character->bytes;
  }
  return std::string(text);
}

// The digits after '@'.
std::int64_t tag_in(std::string_view text, std::size_t& digits) {
  std::int64_t tag = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), tag);
  digits = static_cast<std::size_t>(end - text.data());
  const bool signed_or_none = text.empty() || text[0] < '0' || text[0] > '9';
  if (signed_or_none || error != std::errc{} || tag < 1 || tag > kMaxReplyTag) return 0;
  return tag;
}

}  // namespace

ScriptEnvelope parse_script_message(std::span<const char> message) {
  if (message.size() > kMaxScriptMessageBytes) {
    // The tag is still parsed, so that the sender gets an answer.
    ScriptEnvelope cut = parse_script_message(message.first(kMaxScriptMessageBytes));
    cut.text = fail(fmt::format("the message is longer than {} bytes", kMaxScriptMessageBytes),
                    "put it into a script file and send EXEC_SCRIPT");
    return cut;
  }
  const std::string_view all(message.data(), message.size());
  const std::string_view text = without_blanks(all.substr(0, all.find('\0')));
  const auto offset = [&](std::string_view part) { return static_cast<std::size_t>(part.data() - all.data()); };
  if (text.empty()) return {0, fail("the message has no text", "send one SCRIPT command")};
  if (text.front() != '@') return {0, checked_command(text, offset(text))};

  std::size_t digits = 0;
  const std::int64_t tag = tag_in(text.substr(1), digits);
  if (tag == 0) {
    return {0, fail("the tag after @ is not an integer from 1 to 2147483647", "write @<tag> COMMAND")};
  }
  const std::string_view rest = text.substr(1 + digits);
  const std::string_view command = without_blanks(rest);
  if (command.empty()) return {tag, fail("there is no command after the tag", "write @<tag> COMMAND")};
  if (!is_blank(rest.front())) return {0, fail("no blank after the tag", "write @<tag> COMMAND")};
  return {tag, checked_command(command, offset(command))};
}

std::string script_message_text(std::int64_t tag, std::string_view command) {
  return tag == 0 ? std::string(command) : fmt::format("@{} {}", tag, command);
}

std::string reply_text(const ScriptReply& reply) {
  std::string text(reply.done ? kDone : kRefused);
  if (reply.text.empty()) return text;
  text += ' ';
  for (std::size_t at = 0; at < reply.text.size() && text.size() <= kMaxReplyBytes;) {
    const auto character = utf8_character(std::string_view(reply.text).substr(at));
    const std::size_t bytes = character ? character->bytes : 1;
    const bool plain =
        character && (!is_control_character(character->code) || reply.text[at] == '\n' || reply.text[at] == '\t');
    text += plain ? reply.text.substr(at, bytes) : std::string(character ? " " : "?");
    at += bytes;
  }
  return std::string(cut_utf8(text, kMaxReplyBytes));
}

Result<ScriptReply> parse_reply(std::span<const char> message) {
  const std::string_view all(message.data(), message.size());
  const std::string_view text = all.substr(0, all.find('\0'));
  for (const std::string_view word : {kDone, kRefused}) {
    if (!text.starts_with(word)) continue;
    const std::string_view rest = text.substr(word.size());
    if (!rest.empty() && rest.front() != ' ') break;
    return ScriptReply{word == kDone, std::string(rest.empty() ? rest : rest.substr(1))};
  }
  return fail("the reply begins neither with done nor with refused", "use programs and gateway of the same version");
}

}  // namespace cellmirror
