#include "drivers/can/stream/shared_channel.hpp"

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

constexpr Nanoseconds kLongestWait = 50ms;  // how long a request may have to wait for the thread
constexpr Nanoseconds kToldRefusedAgain = 10s;

}  // namespace

SharedChannel::SharedChannel(CanChannelConfig config, const Clock& clock, CanStreamOptions options)
    : config_(std::move(config)), clock_(&clock), options_(std::move(options)), members_(clock) {
  if (!options_.open_channel) {
    options_.open_channel = [](const CanChannelConfig& what) { return open_can_channel(what, WhereMissing::wait); };
  }
}

SharedChannel::~SharedChannel() { CELLMIRROR_EXPECTS(joined_ == 0); }

Result<void> SharedChannel::join(ChannelMember& member) {
  const std::lock_guard lock(control_mutex_);
  if (joined_ == 0) {
    auto channel = options_.open_channel(config_);
    if (!channel) return std::unexpected(channel.error());
    channel_ = std::move(*channel);
    members_.set_channel(*channel_);
    bus_ = CanBusState::unknown;
    seen_due_ = {};
    waited_ = !channel_->status().waits_for.empty();
    refused_told_ = 0;
    told_refused_ = {};
    stop_ = false;
    members_.add(member, clock_->now());
    publish(false);
    thread_ = std::thread([this] { run(); });
  } else {
    ask({&member, true});
  }
  ++joined_;
  return {};
}

void SharedChannel::leave(ChannelMember& member) {
  const std::lock_guard lock(control_mutex_);
  CELLMIRROR_EXPECTS(joined_ > 0);
  if (--joined_ > 0) return ask({&member, false});
  stop_ = true;
  thread_.join();
  members_.remove(member);
  channel_.reset();
}

void SharedChannel::ask(Request request) {
  std::unique_lock lock(request_mutex_);
  request_ = request;
  requested_ = true;
  served_.wait(lock, [this] { return !request_; });
}

void SharedChannel::serve_request() {
  if (!requested_) return;
  const std::lock_guard lock(request_mutex_);
  requested_ = false;
  const Request request = *std::exchange(request_, std::nullopt);
  if (request.joins) {
    members_.add(*request.member, clock_->now());
    members_.publish();
  } else {
    members_.remove(*request.member);
  }
  served_.notify_all();
}

void SharedChannel::prepare_thread() const {
  pthread_setname_np(pthread_self(), options_.thread_name.substr(0, 15).c_str());
  if (options_.fifo_priority <= 0) return;
  sched_param parameters{};
  parameters.sched_priority = options_.fifo_priority;
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0) {
    log_warning("can.scheduler " + config_.endpoint, "SCHED_FIFO is not allowed: the stream runs without it");
  }
}

void SharedChannel::run() {
  prepare_thread();
  ReceivedCanFrame frame;
  CanReceive last = CanReceive::timeout;
  while (!stop_) {
    serve_request();
    const CanReceive received = channel_->receive(frame, longest_wait());
    const bool is_frame = received == CanReceive::frame;
    const bool opened = waited_ && channel_->status().waits_for.empty();
    if (opened) waited_ = false;
    // The state of the members is outdated, and no other node has received the frames that they sent.
    if (opened || received == CanReceive::again) members_.restart(clock_->now());
    if (is_frame && !frame.frame.error) members_.receive(frame.frame, frame.receive_time);
    members_.deliver_waiting();
    advance_when_due(is_frame, frame.receive_time);
    // The state of the bus can only have changed where no ordinary frame came.
    const bool is_error = is_frame && frame.frame.error;
    if (!is_frame || is_error || last != CanReceive::frame) {
      watch_bus(is_error ? bus_state_of_error(frame.frame) : std::nullopt);
    }
    watch_refused();
    last = received;
    publish(received == CanReceive::end);
  }
}

Nanoseconds SharedChannel::longest_wait() const {
  if (members_.has_waiting()) return 0ns;
  const Timestamp due = members_.next_due();
  return due.known() ? std::clamp<Nanoseconds>(due - clock_->now(), 0ns, kLongestWait) : kLongestWait;
}

// Where this thread was held up, what arrived meanwhile comes before SYNC and timeouts: those answers and heartbeats
// were in time. Frames that arrive from then on do not hold advance() up, so no flood can. One member is advanced a
// turn, so that a SYNC does not wait for all of them.
void SharedChannel::advance_when_due(bool is_frame, Timestamp received) {
  const Timestamp now = clock_->now();
  const Timestamp due = members_.next_due();
  if (due.known() && now >= due && !seen_due_.known()) seen_due_ = now;
  const bool waits = is_frame && received < seen_due_;
  if (!seen_due_.known() || waits) return;
  members_.advance_next(now);
  const Timestamp next = members_.next_due();
  if (!next.known() || next > seen_due_) seen_due_ = {};
}

void SharedChannel::publish(bool ended) {
  Report& report = published_.writable();
  report.channel = channel_->status();
  report.dropped_between_members = members_.dropped();
  report.ended = ended;
  published_.publish();
  members_.publish();
}

void SharedChannel::watch_bus(std::optional<CanBusState> reported) {
  const CanChannelStatus& status = channel_->status();
  const CanBusState bus = reported.value_or(status.bus);
  if (bus == bus_) return;
  const bool was_bad = bus_ == CanBusState::bus_off || bus_ == CanBusState::down;
  bus_ = bus;
  const bool is_bad = bus_ != CanBusState::active && bus_ != CanBusState::unknown;
  if (!was_bad && !is_bad) return;
  const std::string place = "can.bus " + config_.endpoint;
  const bool adds = is_bad && !status.last_error.empty() && status.last_error != words(bus_);
  const std::string text =
      fmt::format("bus: {}{}{}", words(bus_), adds ? ": " : "", adds ? status.last_error : std::string());
  if (!is_bad) return log_info(place, "{}", text);
  log_warning(place, "{}", text);
  members_.keep_error(text);
}

// Does not report refused frames of logs, which refuse every frame, or of a bus that is down, which is reported
// already.
void SharedChannel::watch_refused() {
  const CanChannelStatus& status = channel_->status();
  if (status.send_refused == refused_told_ || status.last_error.empty()) return;
  if (bus_ == CanBusState::down || bus_ == CanBusState::bus_off) {
    refused_told_ = status.send_refused;
    return;
  }
  const Timestamp now = clock_->now();
  if (told_refused_.known() && now - told_refused_ < kToldRefusedAgain) return;
  const std::uint64_t more = status.send_refused - std::exchange(refused_told_, status.send_refused);
  told_refused_ = now;
  const std::string text =
      fmt::format("{} frame{} not sent: {}", more, more == 1 ? " was" : "s were", status.last_error);
  log_warning("can.send " + config_.endpoint, "{}", text);
  members_.keep_error(text);
}

SharedChannel::Report SharedChannel::report() const {
  const std::lock_guard lock(report_mutex_);
  return published_.read().value;
}

std::shared_ptr<SharedChannel> make_shared_channel(const CanChannelConfig& config, const Clock& clock,
                                                   CanStreamOptions options) {
  return std::make_shared<SharedChannel>(config, clock, std::move(options));
}

}  // namespace cellmirror::can
