#include "drivers/can/stream/can_stream.hpp"

#include <fmt/format.h>

#include <utility>

#include "drivers/can/channel/error_frame.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::can {
namespace {

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

void describe_channel(const SharedChannel::Report& report, JointStreamStatus& status) {
  const CanChannelStatus& bus = report.channel;
  status.lost += bus.receive_dropped;
  status.rejected += bus.malformed + bus.foreign;
  if (const std::string condition = bus_condition(bus, report.ended); !condition.empty()) status.condition = condition;
  status.waits_for = bus.waits_for;
  status.details.emplace_back("bus", words(bus.bus));
  status.details.emplace_back(
      "channel", fmt::format("{} received, {} sent, {} refused, {} dropped, {} malformed, {} error frames, {} reopened",
                             bus.received, bus.sent, bus.send_refused, bus.receive_dropped, bus.malformed,
                             bus.error_frames, bus.reopened));
  if (bus.foreign > 0)
    status.details.emplace_back("datagrams of senders beyond allow_from", fmt::format("{}", bus.foreign));
  if (report.dropped_between_members > 0)
    status.details.emplace_back("frames dropped between the nodes", fmt::format("{}", report.dropped_between_members));
  if (!bus.last_error.empty()) status.details.emplace_back("last channel error", bus.last_error);
}

}  // namespace

CanStream::CanStream(std::string kind, std::shared_ptr<SharedChannel> channel, const Clock& clock,
                     MakeProtocol make_protocol)
    : kind_(std::move(kind)), channel_(std::move(channel)), clock_(&clock), make_protocol_(std::move(make_protocol)) {}

CanStream::~CanStream() { close(); }

Result<void> CanStream::open(JointSampleSink& sink) {
  CELLMIRROR_EXPECTS(!open_);
  auto protocol = make_protocol_(*this);
  const std::lock_guard lock(status_mutex_);
  std::swap(protocol_, protocol);
  sink_ = &sink;
  if (auto joined = channel_->join(*this); !joined) {
    std::swap(protocol_, protocol);
    return joined;
  }
  open_ = true;
  return {};
}

void CanStream::close() {
  if (!open_) return;
  channel_->leave(*this);
  sink_ = nullptr;
  const std::lock_guard lock(status_mutex_);
  open_ = false;
}

void CanStream::start(Timestamp now) {
  rate_ = {};
  refused_ = 0;
  begins_ = true;
  last_errors_.clear();
  published_errors_.writable().clear();
  published_errors_.publish();
  protocol_->start(now);
}

void CanStream::publish() {
  published_.write({rate_, refused_});
  protocol_->publish();
}

void CanStream::push(const JointSample& sample) {
  rate_.count(clock_->now());
  if (!std::exchange(begins_, false)) {
    sink_->push(sample);
    return;
  }
  JointSample first = sample;
  first.sequence = JointSample::kBeginsAnew;
  sink_->push(first);
}

void CanStream::note(Severity severity, std::string_view kind, const std::string& text) {
  const std::string place = fmt::format("can.{} {}", kind, channel_->endpoint());
  if (severity == Severity::note) return log_info(place, "{}", text);
  log_warning(place, "{}", text);
  keep_error(text);
}

void CanStream::keep_error(const std::string& text) {
  if (!last_errors_.empty() && last_errors_.back() == text) return;
  if (last_errors_.size() == kErrorsKept) last_errors_.erase(last_errors_.begin());
  last_errors_.push_back(text);
  published_errors_.writable() = last_errors_;
  published_errors_.publish();
}

JointStreamStatus CanStream::status() const {
  JointStreamStatus status;
  status.kind = kind_;
  status.endpoint = channel_->endpoint();
  const std::lock_guard lock(status_mutex_);
  status.open = open_;
  status.condition = "closed";
  if (protocol_ == nullptr) return status;
  const Timestamp now = clock_->now();
  protocol_->describe(status, now);
  const auto& [rate, refused] = published_.read().value;
  if (refused > 0) status.details.emplace_back("frames that the channel refused", fmt::format("{}", refused));
  status.last_errors = published_errors_.read().value;
  if (!open_) {
    status.condition = "closed";
    return status;
  }
  status.rate_hz = rate.per_second(now);
  describe_channel(channel_->report(), status);
  return status;
}

}  // namespace cellmirror::can
