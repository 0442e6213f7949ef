#include "drivers/mqtt/command_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr const char* kRemedy = R"(send {"command": "ROBOT R1 online", "id": 7})";

Result<std::string> read_id(const nlohmann::json& document) {
  const auto found = document.find("id");
  if (found == document.end()) return std::string();
  const auto* text = found->get_ptr<const std::string*>();
  if ((text == nullptr && !found->is_number_integer()) || (text != nullptr && text->size() > kMostIdBytes))
    return fail(fmt::format("the id is no text of up to {} bytes, and no whole number", kMostIdBytes), kRemedy);
  return found->dump();
}

}  // namespace

Result<CommandRequest> parse_command(std::string_view payload, std::string& id) {
  id.clear();
  if (payload.size() > kMostCommandBytes)
    return fail(fmt::format("the command has {} bytes, more than {}", payload.size(), kMostCommandBytes));
  const nlohmann::json document = nlohmann::json::parse(payload, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) return fail("the command is no JSON object", kRemedy);
  auto read = read_id(document);
  if (!read) return std::unexpected(read.error());
  id = *read;
  const auto command = document.find("command");
  const auto* text = command == document.end() ? nullptr : command->get_ptr<const std::string*>();
  if (text == nullptr) return fail("the text \"command\" is missing", kRemedy);
  for (const auto& member : document.items()) {
    if (member.key() != "command" && member.key() != "id")
      return fail(fmt::format("the member {} is not known", printable(member.key())), kRemedy);
  }
  return CommandRequest{*text, *std::move(read)};
}

bool CommandGate::admit(Timestamp now) {
  if (last_.known() && now > last_) left_ = std::min(2 * per_second_, left_ + seconds(now - last_) * per_second_);
  last_ = now;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

}  // namespace cellmirror::mqtt
