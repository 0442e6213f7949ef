#include "drivers/mqtt/topics.hpp"

#include <fmt/format.h>

#include "rt_core/base/utf8.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr std::size_t kMostTopicBytes = 1024;

void add_escaped(std::string& out, std::string_view bytes) {
  for (const char c : bytes) out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
}

}  // namespace

std::string topic_level(std::string_view name) {
  constexpr std::string_view kEscaped = "/+#%";
  std::string out;
  for (std::string_view left = name; !left.empty() && out.size() < kMostLevelBytes;) {
    const auto character = utf8_character(left);
    const std::size_t bytes = character ? character->bytes : 1;
    const bool special = !character || is_control_character(character->code) ||
                         kEscaped.find(left.front()) != std::string_view::npos || (out.empty() && left.front() == '$');
    if (special) {
      add_escaped(out, left.substr(0, bytes));
    } else {
      out += left.substr(0, bytes);
    }
    left.remove_prefix(bytes);
  }
  return out.empty() ? "%00" : out;
}

Topics::Topics(std::string_view prefix, std::string_view cell)
    : base_(fmt::format("{}/{}/", prefix, topic_level(cell))) {}

bool Topics::is_reply(std::string_view topic) const {
  const std::string own = reply();
  if (topic == own) return true;
  return topic.size() <= kMostTopicBytes && topic.starts_with(own + "/") && is_utf8(topic) &&
         topic.find_first_of(std::string_view("+#\0", 3)) == std::string_view::npos;
}

}  // namespace cellmirror::mqtt
