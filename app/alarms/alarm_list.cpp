#include "app/alarms/alarm_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/utf8.hpp"

namespace cellmirror::app {

namespace {

// Names and texts come from cell files and messages: one line, of bounded length.
std::string bounded(std::string_view text, std::size_t most_bytes) {
  return std::string(cut_utf8(drawable_utf8(text), most_bytes));
}

void acknowledge_one(Alarm& alarm, std::string_view name, const AlarmMoment& at) {
  alarm.acknowledged_ms = at.wall_ms;
  alarm.acknowledged_by = name;
}

bool newer(const Alarm& a, const Alarm& b) { return std::pair(a.raised_ms, a.id) > std::pair(b.raised_ms, b.id); }

}  // namespace

void AlarmList::changed(const Alarm& alarm) {
  ++revision_;
  changed_.push_back(alarm);
}

void AlarmList::move_to_history(std::map<Key, Open>::iterator open) {
  history_.push_back(std::move(open->second.alarm));
  if (history_.size() > kMostHistory) history_.pop_front();
  open_.erase(open);
}

Result<void> AlarmList::restore(Alarm alarm, const AlarmMoment& at) {
  if (alarm.id == 0 || alarm.id > kMostIds) return fail(fmt::format("there is no alarm number {}", alarm.id));
  if (!ids_.insert(alarm.id).second) return fail(fmt::format("there are two alarms {}", alarm.id));
  Key key{alarm.kind, alarm.subject};
  const bool over = alarm.state() == AlarmState::normal;
  if (!over && open_.contains(key)) return fail(fmt::format("{} {} is open twice", alarm.kind, alarm.subject));
  if (!over && open_.size() >= kMostOpen) return fail(fmt::format("more than {} alarms are open", kMostOpen));
  last_id_ = std::max(last_id_, alarm.id);
  ++revision_;
  const auto place =
      open_.emplace(std::move(key), Open{.alarm = std::move(alarm), .seen = at, .off_delay = kRestoredDelay}).first;
  if (over) move_to_history(place);
  return {};
}

void AlarmList::raise(Key key, const AlarmCondition& condition, const AlarmMoment& at) {
  if (open_.size() >= kMostOpen) {
    ++not_listed_;
    return;
  }
  Open open{.alarm = {}, .seen = at, .off_delay = condition.off_delay};
  Alarm& alarm = open.alarm;
  alarm.id = ++last_id_;
  alarm.kind = key.first;
  alarm.subject = key.second;
  alarm.text = bounded(condition.text, kMostTextBytes);
  alarm.priority = condition.priority;
  alarm.first_ms = alarm.raised_ms = at.wall_ms;
  ++raised_.at(std::to_underlying(alarm.priority));
  changed(alarm);
  open_.emplace(std::move(key), std::move(open));
}

// An alarm that comes again, or that has become worse, has to be acknowledged again.
void AlarmList::see(Open& open, const AlarmCondition& condition, const AlarmMoment& at) {
  Alarm& alarm = open.alarm;
  open.seen = at;
  open.off_delay = condition.off_delay;
  const bool worse = condition.priority > alarm.priority;
  if (!alarm.cleared_ms && !worse) return;
  alarm.text = bounded(condition.text, kMostTextBytes);
  alarm.priority = alarm.cleared_ms ? condition.priority : std::max(alarm.priority, condition.priority);
  alarm.raised_ms = at.wall_ms;
  alarm.cleared_ms.reset();
  alarm.acknowledged_ms.reset();
  alarm.acknowledged_by.clear();
  ++alarm.occurrences;
  ++raised_.at(std::to_underlying(alarm.priority));
  changed(alarm);
}

void AlarmList::update(std::span<const AlarmCondition> conditions, const AlarmMoment& at) {
  not_listed_ = 0;
  for (const AlarmCondition& condition : conditions) {
    Key key{bounded(condition.kind, kMostSubjectBytes), bounded(condition.subject, kMostSubjectBytes)};
    const auto found = open_.find(key);
    if (found == open_.end())
      raise(std::move(key), condition, at);
    else
      see(found->second, condition, at);
  }
  for (auto one = open_.begin(); one != open_.end();) {
    const auto here = one++;
    Open& open = here->second;
    if (open.alarm.cleared_ms || open.seen.now == at.now || at.now - open.seen.now < open.off_delay) continue;
    open.alarm.cleared_ms = open.seen.wall_ms;
    changed(open.alarm);
    if (open.alarm.acknowledged_ms) move_to_history(here);
  }
}

Result<std::size_t> AlarmList::acknowledge(std::optional<std::uint64_t> id, std::string_view name,
                                           const AlarmMoment& at) {
  if (name.empty() || name.size() > kMostNameBytes)
    return fail(fmt::format("a name has 1 to {} bytes", kMostNameBytes));
  // ALARM_ACK 12 would acknowledge all by that name.
  if (name.front() >= '0' && name.front() <= '9')
    return fail("a name does not begin with a digit", "the name comes first: ALARM_ACK Ada 12");
  std::size_t count = 0;
  bool found = !id;
  for (auto one = open_.begin(); one != open_.end();) {
    const auto here = one++;
    Alarm& alarm = here->second.alarm;
    if (id && alarm.id != *id) continue;
    found = true;
    if (alarm.acknowledged_ms) continue;
    acknowledge_one(alarm, name, at);
    ++count;
    changed(alarm);
    if (alarm.cleared_ms) move_to_history(here);
  }
  if (!found) return fail(fmt::format("no alarm {} is open", *id), "`cellmirror status --json` and the page list them");
  return count;
}

AlarmCounts AlarmList::counts() const {
  AlarmCounts out;
  out.revision = revision_;
  out.raised = raised_;
  out.not_listed = not_listed_;
  for (const auto& [key, open] : open_) {
    const AlarmState state = open.alarm.state();
    ++out.states.at(std::to_underlying(state));
    if (state != AlarmState::acknowledged && (!out.highest || *out.highest < open.alarm.priority))
      out.highest = open.alarm.priority;
  }
  return out;
}

std::vector<Alarm> AlarmList::open() const {
  std::vector<Alarm> out;
  out.reserve(open_.size());
  for (const auto& [key, open] : open_) out.push_back(open.alarm);
  std::ranges::sort(out, newer);
  return out;
}

std::vector<Alarm> AlarmList::history() const { return {history_.rbegin(), history_.rend()}; }

std::vector<Alarm> AlarmList::take_changed() { return std::exchange(changed_, {}); }

}  // namespace cellmirror::app
