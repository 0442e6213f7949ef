// The log's front end. One line per message on standard error, with wall-clock time. Messages are rate limited by kind:
// after kBurst of one kind within a second the rest are counted, and the next message that passes shows the count. Not
// for the tick. As a service of systemd they are entries of the journal with fields of their own (journal.hpp).
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace cellmirror {

enum class LogLevel { debug, info, warning, error };

inline constexpr int kLogBurst = 5;

// From which level on messages are written; default: warning (quiet).
void set_log_level(LogLevel level);

// `kind` names the kind of event for rate limiting, e.g. "can.bus-off robot=PUMA_762"; it is written too. Any thread.
void log_text(LogLevel level, std::string_view kind, std::string_view message);

// Is given every message that is written, without the limit's note; by the thread that logs. It must not log. One;
// empty: none. Returns when no call of the one before is running.
using LogObserver = std::function<void(LogLevel level, std::string_view kind, std::string_view message)>;
void set_log_observer(LogObserver observer);

template <class... Args>
void log_info(std::string_view kind, fmt::format_string<Args...> format, Args&&... args) {
  log_text(LogLevel::info, kind, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_warning(std::string_view kind, fmt::format_string<Args...> format, Args&&... args) {
  log_text(LogLevel::warning, kind, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void log_error(std::string_view kind, fmt::format_string<Args...> format, Args&&... args) {
  log_text(LogLevel::error, kind, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace cellmirror
