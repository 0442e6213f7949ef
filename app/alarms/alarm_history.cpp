#include "app/alarms/alarm_history.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "app/alarms/alarm_line.hpp"
#include "app/alarms/alarm_list.hpp"

namespace cellmirror::app {

namespace {

void sort_newest_first(std::vector<Alarm>& alarms) {
  std::ranges::sort(alarms, [](const Alarm& a, const Alarm& b) {
    return std::pair(a.raised_ms, a.id) > std::pair(b.raised_ms, b.id);
  });
}

AlarmCounts counts_of(const std::vector<Alarm>& open) {
  AlarmCounts out;
  for (const Alarm& alarm : open) {
    ++out.states.at(static_cast<std::size_t>(std::to_underlying(alarm.state())));
    if (!alarm.acknowledged_ms) out.highest = std::max(out.highest.value_or(alarm.priority), alarm.priority);
  }
  return out;
}

}  // namespace

void AlarmHistory::add(std::int64_t time_ns, std::string_view line) {
  if (lines_.size() >= kMostLines) return;
  auto alarm = read_alarm_line(line);
  if (!alarm) return;
  const std::int64_t last = lines_.empty() ? time_ns : lines_.back().time_ns;
  lines_.push_back({std::max(time_ns, last), *std::move(alarm)});
}

AlarmReport AlarmHistory::report_after(std::size_t lines) const {
  std::map<std::uint64_t, const Alarm*> newest;  // by id
  AlarmReport out;
  for (std::size_t i = 0; i < lines; ++i) newest[lines_[i].alarm.id] = &lines_[i].alarm;
  for (const auto& [id, alarm] : newest)
    (alarm->state() == AlarmState::normal ? out.history : out.open).push_back(*alarm);
  sort_newest_first(out.open);
  sort_newest_first(out.history);
  if (out.history.size() > AlarmList::kMostHistory) out.history.resize(AlarmList::kMostHistory);
  out.counts = counts_of(out.open);
  out.counts.revision = lines + 1;
  return out;
}

AlarmReport AlarmHistory::at(std::int64_t time_ns) const {
  const auto lines =
      static_cast<std::size_t>(std::ranges::upper_bound(lines_, time_ns, {}, &Line::time_ns) - lines_.begin());
  const std::scoped_lock lock(mutex_);
  if (!known_ || known_lines_ != lines) {
    known_ = std::make_shared<const AlarmReport>(report_after(lines));
    known_lines_ = lines;
  }
  return *known_;
}

std::vector<AlarmHistory::Raised> AlarmHistory::raised() const {
  std::vector<Raised> out;
  std::set<std::pair<std::uint64_t, std::int64_t>> told;
  for (const Line& line : lines_)
    if (told.emplace(line.alarm.id, line.alarm.raised_ms).second) out.push_back({line.alarm.raised_ms, line.alarm});
  return out;
}

}  // namespace cellmirror::app
