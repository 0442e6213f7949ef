// Any bytes as the file of alarms of an earlier run, or as the alarms of a recording: what is read can be written and
// read again, and is listed within its bounds.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/alarms/alarm_history.hpp"
#include "app/alarms/alarm_line.hpp"
#include "app/alarms/alarm_list.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  using namespace cellmirror::app;
  std::string_view left(reinterpret_cast<const char*>(data), size);
  AlarmList list;
  AlarmHistory recorded;
  std::int64_t time_ns = 0;
  while (!left.empty()) {
    const std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), line.size() + 1));
    recorded.add(++time_ns, line);
    const auto alarm = read_alarm_line(line);
    if (!alarm) continue;
    const auto again = read_alarm_line(alarm_line_of(*alarm));
    CELLMIRROR_EXPECTS(again && *again == *alarm);
    static_cast<void>(list.restore(*alarm, {Timestamp{1}, 1}));
  }
  const AlarmReport then = recorded.at(time_ns / 2);
  CELLMIRROR_EXPECTS(then.history.size() <= AlarmList::kMostHistory && then.counts.active() <= then.open.size());
  CELLMIRROR_EXPECTS(recorded.raised().size() <= static_cast<std::size_t>(time_ns));
  CELLMIRROR_EXPECTS(list.open().size() <= AlarmList::kMostOpen && list.history().size() <= AlarmList::kMostHistory);
  list.update({}, {Timestamp{100'000'000'000}, 100'000});
  CELLMIRROR_EXPECTS(list.counts().active() == 0);
  static_cast<void>(list.acknowledge(std::nullopt, "Ada", {Timestamp{100'000'000'001}, 100'001}));
  CELLMIRROR_EXPECTS(list.open().empty());
  return 0;
}
