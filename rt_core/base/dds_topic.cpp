#include "rt_core/base/dds_topic.hpp"

#include <algorithm>

namespace cellmirror {

namespace {

constexpr std::string_view kTopicPrefix = "rt";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_token(std::string_view token) {
  return !token.empty() && is_letter(token.front()) &&
         std::all_of(token.begin(), token.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace

std::string dds_topic(std::string_view written) {
  return written.starts_with('/') ? std::string(kTopicPrefix).append(written) : std::string(written);
}

bool is_ros_topic(std::string_view dds_name) {
  if (!dds_name.starts_with(kTopicPrefix)) return false;
  std::string_view rest = dds_name.substr(kTopicPrefix.size());
  if (rest.empty()) return false;
  while (!rest.empty()) {
    if (rest.front() != '/') return false;
    rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find('/'), rest.size());
    if (!is_token(rest.substr(0, end))) return false;
    rest.remove_prefix(end);
  }
  return true;
}

}  // namespace cellmirror
