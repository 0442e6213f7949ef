#include "drivers/can/stream/can_stream.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/can/channel/error_frame.hpp"
#include "drivers/can/channel/open_channel.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kLongestWait = 50ms;  // how long close() may have to wait for the thread
constexpr std::size_t kErrorsKept = 16;

// Empty: nothing is wrong with the bus.
std::string bus_condition(const CanChannelStatus& channel, bool ended) {
  if (ended) return "the log has ended";
  if (channel.bus == CanBusState::bus_off) return "bus-off: waiting for the bus";
  if (channel.bus == CanBusState::down) {
    return channel.last_error.empty() ? "bus down: waiting for it" : channel.last_error;
  }
  return {};
}

}  // namespace

CanStream::CanStream(std::string kind, CanChannelConfig channel, const Clock& clock, CanStreamOptions options,
                     MakeProtocol make_protocol)
    : kind_(std::move(kind)),
      channel_config_(std::move(channel)),
      clock_(&clock),
      options_(std::move(options)),
      make_protocol_(std::move(make_protocol)) {
  if (!options_.open_channel) options_.open_channel = open_can_channel;
}

CanStream::~CanStream() { close(); }

Result<void> CanStream::open(JointSampleSink& sink) {
  CELLMIRROR_EXPECTS(!thread_.joinable());
  auto channel = options_.open_channel(channel_config_);
  if (!channel) return std::unexpected(channel.error());
  const std::lock_guard lock(status_mutex_);
  channel_ = std::move(*channel);
  protocol_ = make_protocol_(*this);
  sink_ = &sink;
  rate_ = {};
  last_errors_.clear();
  published_errors_.writable().clear();
  published_errors_.publish();
  bus_ = CanBusState::unknown;
  stop_ = false;
  protocol_->start(clock_->now());
  publish(false);
  thread_ = std::thread([this] { run(); });
  return {};
}

void CanStream::close() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
  sink_ = nullptr;
  const std::lock_guard lock(status_mutex_);
  channel_.reset();
}

void CanStream::prepare_thread() const {
  pthread_setname_np(pthread_self(), options_.thread_name.substr(0, 15).c_str());
  if (options_.fifo_priority <= 0) return;
  sched_param parameters{};
  parameters.sched_priority = options_.fifo_priority;
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0) {
    log_warning("can.scheduler " + channel_config_.endpoint, "SCHED_FIFO is not allowed: the stream runs without it");
  }
}

void CanStream::run() {
  prepare_thread();
  Timestamp due = protocol_->next_due();
  ReceivedCanFrame frame;
  CanReceive last = CanReceive::timeout;
  Timestamp seen_due;  // when this thread first saw that advance() is due
  while (!stop_) {
    const Nanoseconds until_due = due.known() ? due - clock_->now() : kLongestWait;
    const CanReceive received = channel_->receive(frame, std::clamp<Nanoseconds>(until_due, 0ns, kLongestWait));
    const bool is_frame = received == CanReceive::frame;
    if (is_frame && !frame.frame.error) protocol_->receive(frame.frame, frame.receive_time);
    const Timestamp now = clock_->now();
    if (due.known() && now >= due && !seen_due.known()) seen_due = now;
    // Where this thread was held up, what arrived meanwhile comes before SYNC and timeouts: those answers and
    // heartbeats were in time. Frames that arrive from then on do not hold advance() up, so no flood can.
    const bool waits = is_frame && frame.receive_time < seen_due;
    if (seen_due.known() && !waits) {
      protocol_->advance(now);
      seen_due = {};
    }
    due = protocol_->next_due();
    // The state of the bus can only have changed where no ordinary frame came.
    const bool is_error = is_frame && frame.frame.error;
    if (!is_frame || is_error || last != CanReceive::frame) {
      watch_bus(is_error ? bus_state_of_error(frame.frame) : std::nullopt);
    }
    last = received;
    publish(received == CanReceive::end);
  }
}

void CanStream::publish(bool ended) {
  Report& report = published_.writable();
  report.channel = channel_->status();
  report.rate = rate_;
  report.ended = ended;
  published_.publish();
  protocol_->publish();
}

void CanStream::watch_bus(std::optional<CanBusState> reported) {
  const CanChannelStatus& status = channel_->status();
  const CanBusState bus = reported.value_or(status.bus);
  if (bus == bus_) return;
  const bool was_bad = bus_ == CanBusState::bus_off || bus_ == CanBusState::down;
  bus_ = bus;
  const bool is_bad = bus_ != CanBusState::active && bus_ != CanBusState::unknown;
  if (!was_bad && !is_bad) return;
  note(is_bad ? Severity::warning : Severity::note, "bus",
       fmt::format("bus: {}{}{}", words(bus_), is_bad && !status.last_error.empty() ? ": " : "",
                   is_bad ? status.last_error : ""));
}

bool CanStream::send(const CanFrame& frame) { return channel_->send(frame); }

void CanStream::push(const JointSample& sample) {
  rate_.count(clock_->now());
  sink_->push(sample);
}

void CanStream::note(Severity severity, std::string_view kind, const std::string& text) {
  if (severity == Severity::note) {
    log_info(fmt::format("can.{} {}", kind, channel_config_.endpoint), "{}", text);
    return;
  }
  log_warning(fmt::format("can.{} {}", kind, channel_config_.endpoint), "{}", text);
  if (!last_errors_.empty() && last_errors_.back() == text) return;
  if (last_errors_.size() == kErrorsKept) last_errors_.erase(last_errors_.begin());
  last_errors_.push_back(text);
  published_errors_.writable() = last_errors_;
  published_errors_.publish();
}

JointStreamStatus CanStream::status() const {
  JointStreamStatus status;
  status.kind = kind_;
  status.endpoint = channel_config_.endpoint;
  const std::lock_guard lock(status_mutex_);
  status.open = channel_ != nullptr;
  status.condition = "closed";
  if (protocol_ == nullptr) return status;
  const Timestamp now = clock_->now();
  protocol_->describe(status, now);
  status.last_errors = published_errors_.read().value;
  if (channel_ == nullptr) {
    status.condition = "closed";
    return status;
  }
  const auto& [bus, rate, ended] = published_.read().value;
  status.rate_hz = rate.per_second(now);
  status.lost += bus.receive_dropped;
  status.rejected += bus.malformed + bus.foreign;
  if (const std::string condition = bus_condition(bus, ended); !condition.empty()) status.condition = condition;
  status.details.emplace_back("bus", words(bus.bus));
  status.details.emplace_back(
      "channel", fmt::format("{} received, {} sent, {} refused, {} dropped, {} malformed, {} error frames, {} reopened",
                             bus.received, bus.sent, bus.send_refused, bus.receive_dropped, bus.malformed,
                             bus.error_frames, bus.reopened));
  if (bus.foreign > 0)
    status.details.emplace_back("datagrams of senders beyond allow_from", fmt::format("{}", bus.foreign));
  if (!bus.last_error.empty()) status.details.emplace_back("last channel error", bus.last_error);
  return status;
}

}  // namespace cellmirror::can
