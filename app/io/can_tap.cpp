#include "app/io/can_tap.hpp"

#include <algorithm>
#include <utility>

#include "drivers/can/channel/open_channel.hpp"

namespace cellmirror::app {

// The channel of a stream, which sees what passes. Its thread is the queue's producer.
class CanTap::Channel final : public CanChannel {
 public:
  Channel(std::unique_ptr<CanChannel> inner, std::shared_ptr<Line> line, const Clock& clock)
      : inner_(std::move(inner)), line_(std::move(line)), clock_(clock) {}
  // Release: the reader sees the last frames before it drops the line.
  ~Channel() override { line_->closed.store(true, std::memory_order_release); }
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) override {
    const CanReceive outcome = inner_->receive(frame, timeout);
    if (outcome == CanReceive::frame && on()) line_->frames.push({frame.frame, frame.receive_time, false});
    return outcome;
  }
  bool send(const CanFrame& frame) override {
    const bool sent = inner_->send(frame);
    if (sent && on()) line_->frames.push({frame, clock_.now(), true});
    return sent;
  }
  void send_all(std::span<const CanFrame> frames, std::span<bool> sent) override {
    inner_->send_all(frames, sent);
    if (!on()) return;
    const Timestamp now = clock_.now();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (sent[i]) line_->frames.push({frames[i], now, true});
    }
  }
  [[nodiscard]] const CanChannelStatus& status() const override { return inner_->status(); }

 private:
  [[nodiscard]] bool on() const { return line_->on->load(std::memory_order_relaxed); }

  std::unique_ptr<CanChannel> inner_;
  std::shared_ptr<Line> line_;
  const Clock& clock_;
};

can::ChannelOpener CanTap::opener(std::string robot) {
  return [this, robot = std::move(robot)](const CanChannelConfig& config) -> Result<std::unique_ptr<CanChannel>> {
    auto inner = can::open_can_channel(config, can::WhereMissing::wait);
    if (!inner) return inner;
    auto line = std::make_shared<Line>();
    line->robot = robot;
    line->on = on_;
    {
      const std::scoped_lock lock(mutex_);
      lines_.push_back(line);
    }
    return std::make_unique<Channel>(*std::move(inner), std::move(line), clock_);
  };
}

void CanTap::drain(const Take& take, const Missed& missed) {
  std::vector<std::shared_ptr<Line>> lines;
  {
    const std::scoped_lock lock(mutex_);
    lines = lines_;
  }
  bool any_closed = false;
  for (const std::shared_ptr<Line>& line : lines) {
    // Acquire: before the frames are taken, so that none is left behind in a line that is dropped.
    const bool closed = line->closed.load(std::memory_order_acquire);
    TappedCanFrame frame;
    for (std::size_t i = 0; i < kFrames && line->frames.pop(frame); ++i) take(line->robot, frame);
    const std::uint64_t dropped = line->frames.dropped();
    if (dropped > line->dropped_told) missed(line->robot, dropped - line->dropped_told);
    line->dropped_told = dropped;
    any_closed = any_closed || closed;
  }
  if (!any_closed) return;
  const std::scoped_lock lock(mutex_);
  std::erase_if(lines_, [](const std::shared_ptr<Line>& line) {
    return line->closed.load(std::memory_order_acquire) && line->frames.size() == 0;
  });
}

}  // namespace cellmirror::app
