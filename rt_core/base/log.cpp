#include "rt_core/base/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <utility>

#include "rt_core/base/journal.hpp"
#include "rt_core/base/notice.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

std::shared_ptr<spdlog::logger> make_logger(const char* name, spdlog::level::level_enum level) {
  auto made = spdlog::stderr_color_mt(name);
  made->set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  made->set_level(level);
  return made;
}

spdlog::logger& logger() {
  static const auto instance = make_logger("cellmirror", spdlog::level::warn);
  return *instance;
}

// Writes every notice; log_notice() filters by the level of logger().
spdlog::logger& notice_logger() {
  static const auto instance = make_logger("cellmirror-notices", spdlog::level::info);
  return *instance;
}

// As of syslog.
int priority_of(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return 7;
    case LogLevel::info:
      return 6;
    case LogLevel::warning:
      return 4;
    case LogLevel::error:
      return 3;
  }
  return 3;
}

// Where this process is a service, the fields of an entry are worth more than a line of text.
const Journal& journal() {
  static const Journal instance(standard_error_is_journal(std::getenv("JOURNAL_STREAM")) ? "/run/systemd/journal/socket"
                                                                                         : "");
  return instance;
}

struct Allowance {
  Timestamp window_start;
  int written = 0;
  std::uint64_t swallowed = 0;
};

// Answers whether a message of this kind may pass now, and how many were swallowed since the last one that did.
class RateLimit {
 public:
  bool pass(std::string_view kind, std::uint64_t& swallowed) {
    const std::scoped_lock lock(mutex_);
    constexpr std::size_t kKinds = 4096;  // kinds may hold names from outside: bounded, forgetting all at once
    if (allowances_.size() >= kKinds) allowances_.clear();
    Allowance& allowance = allowances_[std::string(kind)];
    const Timestamp now = SystemClock().now();
    if (!allowance.window_start.known() || now - allowance.window_start > std::chrono::seconds(1)) {
      allowance.window_start = now;
      allowance.written = 0;
    }
    if (allowance.written >= kLogBurst) {
      ++allowance.swallowed;
      return false;
    }
    ++allowance.written;
    swallowed = std::exchange(allowance.swallowed, 0);
    return true;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, Allowance, std::less<>> allowances_;
};

// Those who log share the lock; it is taken alone while the observer changes.
std::shared_mutex observing;
LogObserver& current_observer() {
  static LogObserver observer;
  return observer;
}

void write(spdlog::logger& to, LogLevel level, std::string_view kind, std::string_view message) {
  static RateLimit limit;
  std::uint64_t swallowed = 0;
  if (!limit.pass(kind, swallowed)) return;
  if (!journal().send({priority_of(level), kind, message, swallowed})) {
    if (swallowed > 0) {
      to.log(spdlog_level(level), "[{}] {} ({} more of this kind were not written)", kind, message, swallowed);
    } else {
      to.log(spdlog_level(level), "[{}] {}", kind, message);
    }
  }
  const std::shared_lock lock(observing);
  if (current_observer()) current_observer()(level, kind, message);
}

}  // namespace

void set_log_observer(LogObserver observer) {
  const std::unique_lock lock(observing);
  current_observer() = std::move(observer);
}

void set_log_level(LogLevel level) { logger().set_level(spdlog_level(level)); }

void log_text(LogLevel level, std::string_view kind, std::string_view message) {
  if (logger().should_log(spdlog_level(level))) write(logger(), level, kind, message);
}

void log_notice(std::string_view kind, std::string_view message) {
  if (logger().should_log(spdlog::level::warn)) write(notice_logger(), LogLevel::info, kind, message);
}

}  // namespace cellmirror
