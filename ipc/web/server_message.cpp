#include "ipc/web/server_message.hpp"

#include <bit>
#include <nlohmann/json.hpp>

namespace cellmirror::web {

namespace {

using nlohmann::json;

// Text from outside may contain bytes that are not UTF-8.
std::string text_of(const json& document) { return document.dump(-1, ' ', false, json::error_handler_t::replace); }

void append_little_endian(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

std::string welcome_message(const Welcome& welcome) {
  return text_of({{"is", "welcome"},
                  {"version", welcome.version},
                  {"cell", welcome.cell},
                  {"instance", welcome.instance},
                  {"run", welcome.run},
                  {"may_command", welcome.may_command},
                  {"read_only", welcome.read_only}});
}

std::string reply_message(std::int64_t id, const CommandReply& reply) {
  return text_of({{"is", "reply"}, {"id", id}, {"done", reply.done}, {"text", reply.text}});
}

std::string picked_message(std::int64_t id, const std::optional<PickedObject>& picked) {
  return text_of({{"is", "picked"},
                  {"id", id},
                  {"path", picked ? json(picked->path) : json(nullptr)},
                  {"robot", picked ? json(picked->robot) : json("")}});
}

std::string refused_message(std::int64_t id, std::string_view why) {
  return text_of({{"is", "refused"}, {"id", id}, {"text", std::string(why)}});
}

std::string live_message(std::string_view live) {
  const std::size_t brace = live.find('{');
  if (brace == std::string_view::npos) return R"({"is":"live"})";
  const std::string_view members = live.substr(brace + 1);
  const std::size_t first = members.find_first_not_of(" \n\t\r");
  const bool empty = first == std::string_view::npos || members[first] == '}';
  return std::string(empty ? R"({"is":"live")" : R"({"is":"live",)").append(members);
}

std::string command_answer(const CommandReply& reply) {
  json out = {{"done", reply.done}};
  if (!reply.text.empty()) out["text"] = reply.text;
  return text_of(out);
}

std::string poses_header(std::uint32_t sequence, const SceneUpdate& update, Timestamp now) {
  const double age = update.posture_time.known() ? seconds(now - update.posture_time) : 0.0;
  std::string out = "CMS1";
  append_little_endian(out, sequence, 4);
  append_little_endian(out, update.geometry_hash, 8);
  append_little_endian(out, std::bit_cast<std::uint64_t>(age), 8);
  return out;
}

std::string picture_header(std::uint32_t sequence, const EncodedImage& picture, Timestamp now) {
  const double age = picture.posture_time.known() ? seconds(now - picture.posture_time) : 0.0;
  std::string out = "CMP1";
  append_little_endian(out, sequence, 4);
  append_little_endian(out, static_cast<std::uint64_t>(picture.width), 2);
  append_little_endian(out, static_cast<std::uint64_t>(picture.height), 2);
  append_little_endian(out, 0, 4);
  append_little_endian(out, std::bit_cast<std::uint64_t>(age), 8);
  append_little_endian(out, 0, 8);
  return out;
}

}  // namespace cellmirror::web
