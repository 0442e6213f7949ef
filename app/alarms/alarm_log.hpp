// The alarms of the running gateway: asks for the conditions several times a second, keeps the list, and a file of it
// for the time after a restart. A thread of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/alarms/alarm_list.hpp"
#include "app/snapshot/alarm_report.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

class AlarmLog {
 public:
  static constexpr Nanoseconds kLookEvery{200'000'000};
  static constexpr std::uint64_t kMostFileBytes = std::uint64_t{2} << 20;  // a longer file is rewritten

  struct Options {
    std::optional<std::filesystem::path> file;  // its folder exists; none: nothing is kept
    std::string no_file;                        // then: why
  };

  // Reads what an earlier run has left; lines that are wrong are refused one by one, logged and counted.
  AlarmLog(Options options, const Clock& clock);
  ~AlarmLog();
  AlarmLog(const AlarmLog&) = delete;
  AlarmLog& operator=(const AlarmLog&) = delete;

  using Changed = std::function<void(const std::vector<Alarm>& changed)>;

  // `conditions`: all that are so now; `changed`, which may be empty, is given those that have changed. Both are called
  // by the log's thread until stop() has returned.
  void start(std::function<std::vector<AlarmCondition>()> conditions, Changed changed = {});
  // Writes what is left. Alarms can still be acknowledged then, without a file.
  void stop();

  // ALARM_ACK: one alarm, or all (0); the remark says how many. Does not wait for the file. Any thread.
  Result<std::string> acknowledged(std::string_view name, std::uint64_t id);
  // Any thread.
  [[nodiscard]] AlarmCounts counts() const;
  [[nodiscard]] AlarmReport report() const;
  [[nodiscard]] std::string problem() const;

 private:
  void load();
  void watch(const std::stop_token& stop);
  void hand_out(const std::vector<Alarm>& changed);
  void save(const std::vector<Alarm>& changed);
  Result<void> append(const std::vector<Alarm>& changed);
  Result<void> write_anew();
  [[nodiscard]] AlarmMoment moment() const;

  Options options_;
  const Clock& clock_;
  std::function<std::vector<AlarmCondition>()> conditions_;
  Changed changed_;

  // The thread's own.
  Descriptor file_;
  std::uint64_t bytes_ = 0;

  mutable std::mutex mutex_;  // of what follows
  AlarmList list_;
  std::string problem_;
  std::uint64_t refused_lines_ = 0;

  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
