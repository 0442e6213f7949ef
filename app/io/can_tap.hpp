// What the CAN streams receive and send, for a recording: raw frames with their times, from the threads of the streams
// to one reader, without a lock between them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/can/stream/streams.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/rt/fifo.hpp"

namespace cellmirror::app {

struct TappedCanFrame {
  CanFrame frame;
  Timestamp time;  // received, or given to the channel to be sent
  bool sent = false;
};

class CanTap {
 public:
  static constexpr std::size_t kFrames = 4096;  // of one channel, until the reader comes; more are left out and counted

  // `clock` outlives the tap and all channels.
  explicit CanTap(const Clock& clock) : clock_(clock) {}

  // Opens channels whose frames come here under that name; the tap outlives them. Any thread.
  [[nodiscard]] can::ChannelOpener opener(std::string robot);

  // While off, channels give nothing and it costs them a look at a flag.
  void set_on(bool on) { on_->store(on, std::memory_order_relaxed); }
  // Frames since the last call, each channel's in order; `missed`: how many of it found no room. One thread.
  using Take = std::function<void(const std::string& robot, const TappedCanFrame& frame)>;
  using Missed = std::function<void(const std::string& robot, std::uint64_t frames)>;
  void drain(const Take& take, const Missed& missed);

 private:
  class Channel;
  struct Line {
    std::string robot;
    std::shared_ptr<std::atomic<bool>> on;
    std::atomic<bool> closed{false};
    std::uint64_t dropped_told = 0;  // the reader's
    Fifo<TappedCanFrame, kFrames> frames;
  };

  const Clock& clock_;
  std::shared_ptr<std::atomic<bool>> on_ = std::make_shared<std::atomic<bool>>(false);
  std::mutex mutex_;  // of the list; channels do not take it
  std::vector<std::shared_ptr<Line>> lines_;
};

}  // namespace cellmirror::app
