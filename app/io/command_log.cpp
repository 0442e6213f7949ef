#include "app/io/command_log.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/io/line_file.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/utc_text.hpp"
#include "rt_core/base/utf8.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

// Commands come in bursts; one write for many of them.
constexpr std::chrono::milliseconds kGather{20};
constexpr std::size_t kTailBytes = std::size_t{256} << 10;  // of the file, for the entries from before a restart

std::string_view shortened(std::string_view text) { return cut_utf8(text, CommandLog::kMostTextBytes); }

// A script sends more commands than can be written; those of people and other programs keep their places.
std::size_t most_waiting(const CommandRecord& record) {
  const bool of_script = record.source == "file" || record.source == "program";
  return of_script ? CommandLog::kMostWaitingOfScripts : CommandLog::kMostWaiting;
}

std::string dropped_line(std::uint64_t count) {
  JsonWriter out;
  out.begin_object().member("source", "log").member("dropped", count).end_object();
  return out.take();
}

std::filesystem::path numbered(const std::filesystem::path& file, int number) {
  std::filesystem::path out = file;
  out += fmt::format(".{}", number);
  return out;
}

}  // namespace

std::string command_line_of(const CommandRecord& record) {
  JsonWriter out;
  out.begin_object().member("time", utc_text_ms(record.wall_ns)).fixed_member("took_s", record.took_s, 6);
  if (record.tick != 0) out.member("tick", record.tick);
  if (record.loop_command != 0) out.member("loop_command", record.loop_command);
  out.member("source", record.source);
  if (record.process != 0) out.member("process", record.process);
  if (record.user) out.member("user", *record.user);
  if (record.session != 0) out.member("session", record.session);
  if (!record.peer.empty()) out.member("peer", record.peer);
  if (!record.place.empty()) out.member("place", record.place);
  if (record.run != 0) out.member("run", record.run);
  out.member("command", shortened(record.command)).member("outcome", record.done ? "done" : "refused");
  if (!record.answer.empty()) out.member("answer", shortened(record.answer));
  out.end_object();
  return out.take();
}

CommandLog::CommandLog(Options options) : options_(std::move(options)) {
  load_last();
  thread_ = std::thread([this] { loop(); });
}

CommandLog::~CommandLog() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  came_.notify_all();
  thread_.join();
}

void CommandLog::add(CommandRecord record) {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= most_waiting(record)) {
      ++dropped_;
      return;
    }
    waiting_.push_back(std::move(record));
  }
  came_.notify_all();
}

CommandLogReport CommandLog::report() const {
  const std::scoped_lock lock(mutex_);
  return {options_.file.string(), written_, dropped_, problem_, {last_.begin(), last_.end()}};
}

std::uint64_t CommandLog::count() const {
  const std::scoped_lock lock(mutex_);
  return count_;
}

// What others may have written into the file is shown only where it is an object of JSON.
void CommandLog::load_last() {
  const std::string text = tail_of(options_.file, kTailBytes);
  std::string_view left = text;
  const std::scoped_lock lock(mutex_);
  while (!left.empty()) {
    const std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), line.size() + 1));
    const auto document = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (document.is_object()) keep(document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
}

void CommandLog::keep(std::string line) {
  ++count_;
  last_.push_back(std::move(line));
  if (last_.size() > kKept) last_.pop_front();
}

void CommandLog::loop() {
  set_thread_name("command-log");
  for (;;) {
    std::vector<CommandRecord> records;
    std::uint64_t dropped = 0;
    bool ending = false;
    {
      std::unique_lock lock(mutex_);
      came_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      came_.wait_for(lock, kGather, [this] { return ending_; });
      records.swap(waiting_);
      dropped = dropped_ - dropped_noted_;
      ending = ending_;
    }
    write(records, dropped);
    if (ending && records.empty()) return;
  }
}

void CommandLog::write(const std::vector<CommandRecord>& records, std::uint64_t dropped) {
  if (records.empty() && dropped == 0) return;
  std::vector<std::string> lines;
  lines.reserve(records.size() + 1);
  for (const CommandRecord& record : records) lines.push_back(command_line_of(record));
  if (dropped > 0) lines.push_back(dropped_line(dropped));
  std::string text;
  for (const std::string& line : lines) (text += line) += '\n';
  const Result<void> appended = append(text);
  const std::scoped_lock lock(mutex_);
  for (std::string& line : lines) keep(std::move(line));
  const std::string problem = appended ? std::string() : appended.error().text();
  if (appended) {
    written_ += records.size();
    dropped_noted_ += dropped;
  } else {
    dropped_ += records.size();
  }
  if (!problem.empty() && problem != problem_) log_error("command-log", "{}", problem);
  problem_ = problem;
}

Result<void> CommandLog::open() {
  auto opened = open_line_file(options_.file);
  if (!opened) {
    file_.reset();
    return fail(fmt::format("the log of commands {} cannot be written: {}", options_.file.string(), opened.error()),
                "make its folder writable for the user of the gateway; until then no command leaves a trace");
  }
  file_ = std::move(opened->file);
  bytes_ = opened->bytes;
  return {};
}

// Names that cannot be changed leave a file that is too long, which the next try finds again.
void CommandLog::rotate() {
  file_.reset();
  std::error_code ignored;
  if (options_.old_files < 1) {
    std::filesystem::remove(options_.file, ignored);
    return;
  }
  std::filesystem::remove(numbered(options_.file, options_.old_files), ignored);
  for (int number = options_.old_files - 1; number >= 1; --number)
    std::filesystem::rename(numbered(options_.file, number), numbered(options_.file, number + 1), ignored);
  std::filesystem::rename(options_.file, numbered(options_.file, 1), ignored);
}

Result<void> CommandLog::append(const std::string& lines) {
  // Another program may have removed or renamed it, as logrotate does.
  struct stat now{};
  struct stat mine{};
  const bool same = file_.valid() && ::fstat(file_.get(), &mine) == 0 && ::lstat(options_.file.c_str(), &now) == 0 &&
                    mine.st_ino == now.st_ino && mine.st_dev == now.st_dev;
  if (!same) {
    if (auto opened = open(); !opened) return opened;
  }
  if (bytes_ > 0 && bytes_ + lines.size() > options_.most_bytes) {
    rotate();
    if (auto opened = open(); !opened) return opened;
  }
  if (!write_all(file_.get(), lines)) {
    const int reason = errno;
    // Half a line would make the next one unreadable.
    [[maybe_unused]] const int cut = ::ftruncate(file_.get(), static_cast<off_t>(bytes_));
    return fail(
        fmt::format("the log of commands {} cannot be written: {}", options_.file.string(), std::strerror(reason)),
        "make room on the disk; until then no command leaves a trace");
  }
  bytes_ += lines.size();
  return {};
}

}  // namespace cellmirror::app
