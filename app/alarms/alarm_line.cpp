#include "app/alarms/alarm_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/alarms/alarm_list.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::uint64_t kLatestMs = 9'223'372'036'854;  // in the year 2262: as nanoseconds it has 63 bits
constexpr std::size_t kMostKindBytes = 32;

JsonWriter& add_time(JsonWriter& out, std::string_view name, const std::optional<std::int64_t>& time_ms) {
  out.key(name);
  return time_ms ? out.value(*time_ms) : out.null();
}

// Reads the members of one object; the first thing that is wrong counts.
class Members {
 public:
  explicit Members(const json& object) : object_(object) {}

  std::string text(const char* key, std::size_t most_bytes, bool may_be_empty = false) {
    const json* found = member(key);
    if (found == nullptr) return {};
    const auto* value = found->get_ptr<const std::string*>();
    if (value == nullptr || value->size() > most_bytes || (value->empty() && !may_be_empty) ||
        drawable_utf8(*value) != *value) {
      refuse(key, "is no text that an alarm can have");
      return {};
    }
    return *value;
  }

  std::uint64_t number(const char* key, std::uint64_t least, std::uint64_t most) {
    const json* found = member(key);
    if (found == nullptr) return least;
    const auto* value = found->get_ptr<const json::number_unsigned_t*>();
    if (value == nullptr || *value < least || *value > most) {
      refuse(key, "is no number that an alarm can have");
      return least;
    }
    return *value;
  }

  std::int64_t time(const char* key) { return static_cast<std::int64_t>(number(key, 0, kLatestMs)); }

  std::optional<std::int64_t> optional_time(const char* key) {
    const json* found = member(key);
    if (found == nullptr || found->is_null()) return std::nullopt;
    return time(key);
  }

  void refuse(const char* key, const char* why) {
    if (problem_.empty()) problem_ = fmt::format("{} {}", key, why);
  }

  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  const json* member(const char* key) {
    const auto found = object_.find(key);
    if (found != object_.end()) return &*found;
    refuse(key, "is missing");
    return nullptr;
  }

  const json& object_;
  std::string problem_;
};

}  // namespace

std::string alarm_line_of(const Alarm& alarm) {
  JsonWriter out;
  out.begin_object()
      .member("id", alarm.id)
      .member("kind", std::string_view(alarm.kind))
      .member("subject", std::string_view(alarm.subject))
      .member("text", std::string_view(alarm.text))
      .member("priority", word(alarm.priority))
      .member("occurrences", alarm.occurrences)
      .member("first_ms", alarm.first_ms)
      .member("raised_ms", alarm.raised_ms);
  add_time(out, "cleared_ms", alarm.cleared_ms);
  add_time(out, "acknowledged_ms", alarm.acknowledged_ms);
  out.member("acknowledged_by", std::string_view(alarm.acknowledged_by)).end_object();
  return out.take();
}

Result<Alarm> read_alarm_line(std::string_view line) {
  if (line.size() > kMostAlarmLineBytes) return fail(fmt::format("it has more than {} bytes", kMostAlarmLineBytes));
  const json document = json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) return fail("it is no JSON object");
  Members members(document);
  Alarm out;
  out.id = members.number("id", 1, AlarmList::kMostIds);
  out.kind = members.text("kind", kMostKindBytes);
  out.subject = members.text("subject", AlarmList::kMostSubjectBytes);
  out.text = members.text("text", AlarmList::kMostTextBytes, true);
  const auto priority = std::ranges::find(kAlarmPriorityWords, members.text("priority", kMostKindBytes));
  if (priority == kAlarmPriorityWords.end()) {
    members.refuse("priority", "is not low, medium or high");
  } else {
    out.priority = static_cast<AlarmPriority>(priority - kAlarmPriorityWords.begin());
  }
  out.occurrences = members.number("occurrences", 1, AlarmList::kMostIds);
  out.first_ms = members.time("first_ms");
  out.raised_ms = members.time("raised_ms");
  out.cleared_ms = members.optional_time("cleared_ms");
  out.acknowledged_ms = members.optional_time("acknowledged_ms");
  out.acknowledged_by = members.text("acknowledged_by", AlarmList::kMostNameBytes, true);
  if (out.acknowledged_ms.has_value() == out.acknowledged_by.empty())
    members.refuse("acknowledged_by", "does not fit acknowledged_ms");
  if (!members.problem().empty()) return fail(members.problem());
  return out;
}

}  // namespace cellmirror::app
