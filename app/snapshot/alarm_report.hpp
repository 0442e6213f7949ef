// Alarms as status, the page and metrics show them. Terms as in ISA-18.2 and IEC 62682. Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cellmirror::app {

enum class AlarmPriority : std::uint8_t { low, medium, high };
inline constexpr std::array<std::string_view, 3> kAlarmPriorityWords = {"low", "medium", "high"};

enum class AlarmState : std::uint8_t {
  unacknowledged,          // active, nobody has acknowledged it
  acknowledged,            // active
  cleared_unacknowledged,  // its condition has ended, nobody has acknowledged it
  normal,                  // over: part of the history
};
inline constexpr std::array<std::string_view, 4> kAlarmStateWords = {"active_unacknowledged", "active_acknowledged",
                                                                     "cleared_unacknowledged", "normal"};

[[nodiscard]] constexpr std::string_view word(AlarmPriority priority) {
  return kAlarmPriorityWords.at(std::to_underlying(priority));
}
[[nodiscard]] constexpr std::string_view word(AlarmState state) {
  return kAlarmStateWords.at(std::to_underlying(state));
}

// Times in ms since 1970 (UTC).
struct Alarm {
  std::uint64_t id = 0;   // from 1; counts over restarts
  std::string kind;       // collision, near, stream, loop, haptic, bleeding, tissue, or problem
  std::string subject;    // what it is about; with `kind` it tells one alarm from another
  std::string text = {};  // for people
  AlarmPriority priority = AlarmPriority::low;
  std::uint64_t occurrences = 1;                // since it was normal
  std::int64_t first_ms = 0;                    // of the first of them
  std::int64_t raised_ms = 0;                   // of the newest
  std::optional<std::int64_t> cleared_ms = {};  // none: it is active
  std::optional<std::int64_t> acknowledged_ms = {};
  std::string acknowledged_by = {};

  [[nodiscard]] AlarmState state() const {
    if (cleared_ms) return acknowledged_ms ? AlarmState::normal : AlarmState::cleared_unacknowledged;
    return acknowledged_ms ? AlarmState::acknowledged : AlarmState::unacknowledged;
  }
  bool operator==(const Alarm&) const = default;
};

// What is shown everywhere.
struct AlarmCounts {
  std::uint64_t revision = 0;             // another one where any alarm has changed
  std::array<std::size_t, 3> states{};    // by AlarmState, without those that are normal
  std::optional<AlarmPriority> highest;   // of those that nobody has acknowledged
  std::array<std::uint64_t, 3> raised{};  // since the start, by priority
  std::uint64_t not_listed = 0;           // conditions there is no place for now

  [[nodiscard]] std::size_t unacknowledged() const { return states[0] + states[2]; }
  [[nodiscard]] std::size_t active() const { return states[0] + states[1]; }
};

struct AlarmReport {
  AlarmCounts counts;
  std::vector<Alarm> open;          // that are not normal, newest first
  std::vector<Alarm> history;       // that are, newest first
  std::string file;                 // empty: nothing is kept over a restart
  std::string problem;              // why it cannot be written; empty: nothing is wrong
  std::uint64_t refused_lines = 0;  // of the file, at the start
};

}  // namespace cellmirror::app
