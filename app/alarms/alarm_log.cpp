#include "app/alarms/alarm_log.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

#include "app/alarms/alarm_line.hpp"
#include "app/io/line_file.hpp"
#include "app/io/record_file.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kTailBytes = 2 * AlarmLog::kMostFileBytes;
constexpr std::size_t kRefusedLogged = 5;

std::string lines_of(const std::vector<Alarm>& alarms) {
  std::string out;
  for (const Alarm& alarm : alarms) (out += alarm_line_of(alarm)) += '\n';
  return out;
}

// Another program may have removed or renamed it.
bool is_still(int file, const std::filesystem::path& path) {
  struct stat now{};
  struct stat mine{};
  return ::fstat(file, &mine) == 0 && ::lstat(path.c_str(), &now) == 0 && mine.st_ino == now.st_ino &&
         mine.st_dev == now.st_dev;
}

}  // namespace

AlarmLog::AlarmLog(Options options, const Clock& clock) : options_(std::move(options)), clock_(clock) {
  if (options_.file)
    load();
  else
    problem_ = options_.no_file;
}

AlarmLog::~AlarmLog() { stop(); }

AlarmMoment AlarmLog::moment() const {
  const Timestamp now = clock_.now();
  return {now, to_wall_clock_ns(now) / 1'000'000};
}

// The last line of an alarm counts. Those that were active are cleared unless their condition is seen again.
void AlarmLog::load() {
  const std::string text = tail_of(*options_.file, kTailBytes);
  std::string_view left = text;
  if (text.size() == kTailBytes) left.remove_prefix(std::min(left.size(), left.find('\n') + 1));
  std::vector<std::pair<std::size_t, Alarm>> alarms;  // with their lines
  std::map<std::uint64_t, std::size_t> last;          // by id: place in `alarms`
  const auto refuse = [&](std::size_t line, const std::string& why) {
    if (++refused_lines_ <= kRefusedLogged)
      log_warning("alarms", "line {} of {} was left out: {}", line, options_.file->string(), why);
  };
  for (std::size_t number = 1; !left.empty(); ++number) {
    const std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), line.size() + 1));
    auto alarm = read_alarm_line(line);
    if (!alarm) {
      refuse(number, alarm.error().what);
      continue;
    }
    last[alarm->id] = alarms.size();
    alarms.emplace_back(number, *std::move(alarm));
  }
  const AlarmMoment at = moment();
  for (std::size_t i = 0; i < alarms.size(); ++i) {
    if (last.at(alarms[i].second.id) != i) continue;
    if (const auto kept = list_.restore(std::move(alarms[i].second), at); !kept)
      refuse(alarms[i].first, kept.error().what);
  }
}

void AlarmLog::start(std::function<std::vector<AlarmCondition>()> conditions, Changed changed) {
  conditions_ = std::move(conditions);
  changed_ = std::move(changed);
  thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void AlarmLog::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

void AlarmLog::watch(const std::stop_token& stop) {
  set_thread_name("alarms");
  while (!stop.stop_requested()) {
    const std::vector<AlarmCondition> conditions = conditions_();
    std::vector<Alarm> changed;
    {
      const std::scoped_lock lock(mutex_);
      list_.update(conditions, moment());
      changed = list_.take_changed();
    }
    hand_out(changed);
    wake_.wait(kLookEvery);
  }
  std::vector<Alarm> changed;
  {
    const std::scoped_lock lock(mutex_);
    changed = list_.take_changed();
  }
  hand_out(changed);
}

void AlarmLog::hand_out(const std::vector<Alarm>& changed) {
  if (changed.empty()) return;
  if (changed_) changed_(changed);
  save(changed);
}

void AlarmLog::save(const std::vector<Alarm>& changed) {
  if (!options_.file) return;
  const Result<void> saved = append(changed);
  const std::string problem = saved ? std::string() : saved.error().text();
  const std::scoped_lock lock(mutex_);
  if (!problem.empty() && problem != problem_) log_error("alarms", "{}", problem);
  problem_ = problem;
}

Result<void> AlarmLog::append(const std::vector<Alarm>& changed) {
  const auto failed = [&](const std::string& why) {
    file_.reset();
    return fail(fmt::format("the alarms cannot be written to {}: {}", options_.file->string(), why),
                "make room for it, and its folder writable for the user of the gateway; until then a restart forgets "
                "what has changed");
  };
  if (!file_.valid() || !is_still(file_.get(), *options_.file)) {
    auto opened = open_line_file(*options_.file);
    if (!opened) return failed(opened.error());
    file_ = std::move(opened->file);
    bytes_ = opened->bytes;
  }
  const std::string lines = lines_of(changed);
  if (bytes_ + lines.size() > kMostFileBytes) return write_anew();
  if (!write_all(file_.get(), lines)) {
    const int reason = errno;
    // Half a line would make the next one unreadable.
    [[maybe_unused]] const int cut = ::ftruncate(file_.get(), static_cast<off_t>(bytes_));
    return failed(std::strerror(reason));
  }
  bytes_ += lines.size();
  return {};
}

// Only what is known now, each alarm once.
Result<void> AlarmLog::write_anew() {
  file_.reset();
  std::vector<Alarm> all;
  {
    const std::scoped_lock lock(mutex_);
    all = list_.history();
    std::ranges::reverse(all);
    std::ranges::move(list_.open(), std::back_inserter(all));
  }
  auto out = RecordFile::create(*options_.file);
  if (!out) return std::unexpected(out.error());
  if (auto written = out->write(lines_of(all)); !written) return written;
  return out->finish();
}

Result<std::string> AlarmLog::acknowledged(std::string_view name, std::uint64_t id) {
  const std::scoped_lock lock(mutex_);
  const auto one = id == 0 ? std::nullopt : std::optional(id);
  const auto count = list_.acknowledge(one, name, moment());
  if (!count) return std::unexpected(count.error());
  wake_.wake();
  if (one && *count == 0) return fmt::format("alarm {} was acknowledged before", id);
  return one ? std::string() : number_of(*count, "alarm") + " acknowledged";
}

AlarmCounts AlarmLog::counts() const {
  const std::scoped_lock lock(mutex_);
  return list_.counts();
}

AlarmReport AlarmLog::report() const {
  const std::scoped_lock lock(mutex_);
  return {.counts = list_.counts(),
          .open = list_.open(),
          .history = list_.history(),
          .file = options_.file ? options_.file->string() : std::string(),
          .problem = problem_,
          .refused_lines = refused_lines_};
}

std::string AlarmLog::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

}  // namespace cellmirror::app
