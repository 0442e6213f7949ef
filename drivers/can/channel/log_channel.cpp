#include "drivers/can/channel/log_channel.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "drivers/can/channel/candump_line.hpp"
#include "drivers/can/channel/error_frame.hpp"
#include "drivers/can/channel/log_format.hpp"

namespace cellmirror::can {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class LogChannel final : public CanChannel {
 public:
  LogChannel(const LogChannelOptions& options, File file) : options_(options), file_(std::move(file)) {
    status_.bus = CanBusState::active;
  }

  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) override {
    const Timestamp deadline = clock_.now() + timeout;
    while (!next_) {
      if (ended_) return wait_and_end(timeout);
      if (!read_line() && !ended_) return CanReceive::again;
      if (clock_.now() > deadline) return CanReceive::timeout;  // a long run of broken lines
    }
    const Timestamp due = due_time();
    if (due > deadline) {
      sleep_until(deadline);
      return CanReceive::timeout;
    }
    sleep_until(due);
    frame = {next_->frame, clock_.now()};
    next_.reset();
    count(frame.frame);
    return CanReceive::frame;
  }

  bool send(const CanFrame&) override {
    ++status_.send_refused;
    return false;
  }

  [[nodiscard]] const CanChannelStatus& status() const override { return status_; }

 private:
  struct Next {
    CanFrame frame;
    std::int64_t time_ns = 0;
  };

  void count(const CanFrame& frame) {
    if (!frame.error) {
      ++status_.received;
      // A frame proves that the bus is not off.
      if (status_.bus == CanBusState::bus_off) status_.bus = CanBusState::active;
      return;
    }
    ++status_.error_frames;
    status_.last_error = error_words(frame);
    if (const auto bus = bus_state_of_error(frame)) status_.bus = *bus;
  }

  CanReceive wait_and_end(Nanoseconds timeout) {
    sleep_until(clock_.now() + timeout);
    return CanReceive::end;
  }

  void sleep_until(Timestamp until) {
    const Nanoseconds left = until - clock_.now();
    if (left.count() > 0) std::this_thread::sleep_for(left);
  }

  // When the next frame is due. The first frame of a pass, and one whose stamp lies before it, is due at once.
  Timestamp due_time() {
    const Timestamp now = clock_.now();
    if (options_.as_fast_as_possible) return now;
    if (!pass_started_.known()) {
      pass_started_ = now;
      first_stamp_ns_ = next_->time_ns;
    }
    return pass_started_ + Nanoseconds(std::max<std::int64_t>(0, next_->time_ns - first_stamp_ns_));
  }

  // False at the end of the file.
  bool read_line() {
    std::array<char, kCandumpLineCapacity + 2> buffer{};
    if (std::fgets(buffer.data(), static_cast<int>(buffer.size()), file_.get()) == nullptr) {
      start_again();
      return false;
    }
    ++line_;
    std::string_view text(buffer.data());
    if (text.ends_with('\n')) {
      text.remove_suffix(1);
    } else if (std::feof(file_.get()) == 0) {
      skip_rest_of_line();
      broken("the line is too long or holds a NUL byte");
      return true;
    }
    if (text.empty()) return true;
    const auto parsed = parse_candump_line(text);
    if (!parsed) {
      broken(parsed.error());
      return true;
    }
    ++frames_of_pass_;
    next_ = Next{parsed->frame, parsed->time_ns};
    return true;
  }

  void skip_rest_of_line() {
    int c = 0;
    while ((c = std::fgetc(file_.get())) != EOF && c != '\n') {
    }
  }

  void start_again() {
    // A pass without a single frame would repeat for nothing.
    ended_ = !options_.repeat || frames_of_pass_ == 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0;
    line_ = 0;
    frames_of_pass_ = 0;
    pass_started_ = {};
  }

  void broken(std::string_view reason) {
    ++status_.malformed;
    status_.last_error = fmt::format("{}:{}: {}", options_.file, line_, reason);
  }

  LogChannelOptions options_;
  File file_;
  CanChannelStatus status_;
  SystemClock clock_;
  std::optional<Next> next_;
  bool ended_ = false;
  std::uint64_t line_ = 0;
  std::uint64_t frames_of_pass_ = 0;
  Timestamp pass_started_;
  std::int64_t first_stamp_ns_ = 0;
};

}  // namespace

Result<std::unique_ptr<CanChannel>> open_log_channel(const LogChannelOptions& options) {
  struct stat info{};
  if (stat(options.file.c_str(), &info) != 0) {
    return fail(fmt::format("cannot read the log {}: {}", options.file, std::strerror(errno)), "check the path");
  }
  if (!S_ISREG(info.st_mode)) return fail(options.file + " is no regular file", "name a candump log file");
  File file(std::fopen(options.file.c_str(), "re"));
  if (!file) {
    return fail(fmt::format("cannot read the log {}: {}", options.file, std::strerror(errno)), "check its permissions");
  }
  std::array<char, kLogBeginning> beginning{};
  const std::size_t read = std::fread(beginning.data(), 1, beginning.size(), file.get());
  if (const auto known = check_log_beginning({beginning.data(), read}, read < beginning.size()); !known)
    return fail(fmt::format("{}: {}", options.file, known.error().what), known.error().remedy);
  std::rewind(file.get());
  return std::make_unique<LogChannel>(options, std::move(file));
}

Result<void> check_log(const std::string& file) {
  LogChannelOptions options;
  options.file = file;
  if (auto opened = open_log_channel(options); !opened) return std::unexpected(opened.error());
  return {};
}

}  // namespace cellmirror::can
