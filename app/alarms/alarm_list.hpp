// The states of alarms after ISA-18.2 (section 5.5) and IEC 62682. No clock, no file, no thread.
//
//   normal -> active unacknowledged -> active acknowledged -> normal
//                    |       ^                   | (with a higher priority: unacknowledged again)
//                    v       |
//             cleared unacknowledged -> (acknowledged) normal
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/snapshot/alarm_report.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// Something that is so now and should be known. The same kind and subject: the same alarm.
struct AlarmCondition {
  std::string kind;
  std::string subject;
  std::string text;  // kept as it was when the alarm was raised
  AlarmPriority priority = AlarmPriority::low;
  Nanoseconds off_delay{};  // how long it has to be gone before the alarm is cleared (ISA-18.2), against chattering
};

struct AlarmMoment {
  Timestamp now;  // for delays
  std::int64_t wall_ms = 0;
};

class AlarmList {
 public:
  static constexpr std::size_t kMostOpen = 500;
  static constexpr std::size_t kMostHistory = 500;
  static constexpr std::size_t kMostSubjectBytes = 200;  // longer texts are cut
  static constexpr std::size_t kMostTextBytes = 400;
  static constexpr std::size_t kMostNameBytes = 64;
  static constexpr std::uint64_t kMostIds = 1'000'000'000'000;
  static constexpr Nanoseconds kRestoredDelay{10'000'000'000};  // after a start, for its condition to be found again

  // Of an earlier run, before the first update(). Refused, with the reason, where it contradicts another one.
  Result<void> restore(Alarm alarm, const AlarmMoment& at);
  // `conditions`: all that are so now. What is no longer among them is cleared after its delay.
  void update(std::span<const AlarmCondition> conditions, const AlarmMoment& at);
  // One alarm, or all; returns how many changed. An acknowledged alarm keeps the name that it has.
  Result<std::size_t> acknowledge(std::optional<std::uint64_t> id, std::string_view name, const AlarmMoment& at);

  [[nodiscard]] AlarmCounts counts() const;
  [[nodiscard]] std::vector<Alarm> open() const;     // newest first
  [[nodiscard]] std::vector<Alarm> history() const;  // newest first
  // Those that have changed since the last call, as they are now, by id.
  [[nodiscard]] std::vector<Alarm> take_changed();

 private:
  using Key = std::pair<std::string, std::string>;  // kind, subject
  struct Open {
    Alarm alarm;
    AlarmMoment seen;
    Nanoseconds off_delay{};
  };

  void raise(Key key, const AlarmCondition& condition, const AlarmMoment& at);
  void see(Open& open, const AlarmCondition& condition, const AlarmMoment& at);
  void changed(const Alarm& alarm);
  void move_to_history(std::map<Key, Open>::iterator open);

  std::map<Key, Open> open_;
  std::deque<Alarm> history_;  // newest last
  std::vector<Alarm> changed_;
  std::set<std::uint64_t> ids_;  // restored
  std::uint64_t last_id_ = 0;
  std::uint64_t revision_ = 0;
  std::array<std::uint64_t, 3> raised_{};
  std::uint64_t not_listed_ = 0;
};

}  // namespace cellmirror::app
