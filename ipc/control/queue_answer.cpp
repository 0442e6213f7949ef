#include "ipc/control/queue_answer.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

namespace cellmirror {

std::string queue_answer_text(const QueueAnswer& answer) {
  const nlohmann::json document{{"script_queue", answer.script_queue},
                                {"script_problem", answer.script_problem},
                                {"reply_queue", answer.reply_queue},
                                {"reply_problem", answer.reply_problem}};
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<QueueAnswer> parse_queue_answer(std::string_view text) {
  const auto unreadable = [](std::string_view why) {
    return fail(fmt::format("the gateway's answer about its queues cannot be read: {}", why),
                "gateway and this program may be of different versions");
  };
  try {
    const auto document = nlohmann::json::parse(text);
    QueueAnswer answer;
    const auto number = [&](const char* name, std::int32_t& into) {
      const auto& value = document.at(name);
      if (!value.is_number_unsigned() || !std::in_range<std::int32_t>(value.get<std::uint64_t>())) return false;
      into = value.get<std::int32_t>();
      return true;
    };
    if (!number("script_queue", answer.script_queue) || !number("reply_queue", answer.reply_queue))
      return unreadable("a queue has no number");
    answer.script_problem = document.at("script_problem").get<std::string>();
    answer.reply_problem = document.at("reply_problem").get<std::string>();
    return answer;
  } catch (const nlohmann::json::exception& error) {
    return unreadable(error.what());
  }
}

}  // namespace cellmirror
