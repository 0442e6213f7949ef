#include "drivers/can/channel/virtual_bus.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

#include "drivers/can/channel/error_frame.hpp"

namespace cellmirror::can {

struct VirtualCanBus::State {
  struct Waiting {
    CanFrame frame;
    Timestamp due;
  };
  struct Port {
    std::deque<Waiting> queue;
    CanChannelStatus status;
  };

  // Under `mutex`.
  void deliver(const CanFrame& frame, const Port* sender) {
    const Timestamp due = SystemClock().now() + delay;
    for (Port* port : ports) {
      if (port == sender) continue;
      if (port->queue.size() >= capacity) {
        port->queue.pop_front();
        ++port->status.receive_dropped;
      }
      port->queue.push_back({frame, due});
    }
    arrived.notify_all();
  }

  std::mutex mutex;
  std::condition_variable arrived;
  std::vector<Port*> ports;
  CanBusState bus = CanBusState::active;
  Filter filter;
  Nanoseconds delay{0};
  std::size_t refusals = 0;
  std::size_t capacity = 0;
};

class VirtualCanBus::Member final : public CanChannel {
 public:
  explicit Member(std::shared_ptr<State> state) : state_(std::move(state)) {
    const std::lock_guard lock(state_->mutex);
    state_->ports.push_back(&port_);
  }
  ~Member() override {
    const std::lock_guard lock(state_->mutex);
    std::erase(state_->ports, &port_);
  }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  CanReceive receive(ReceivedCanFrame& frame, Nanoseconds timeout) override {
    const Timestamp deadline = SystemClock().now() + timeout;
    std::unique_lock lock(state_->mutex);
    for (;;) {
      const Timestamp now = SystemClock().now();
      const bool due = !port_.queue.empty() && port_.queue.front().due <= now;
      if (due) {
        take(frame, now);
        return CanReceive::frame;
      }
      if (now >= deadline) return state_->bus == CanBusState::down ? CanReceive::down : CanReceive::timeout;
      Timestamp until = deadline;
      if (!port_.queue.empty()) until = std::min(until, port_.queue.front().due);
      state_->arrived.wait_for(lock, until - now);
    }
  }

  bool send(const CanFrame& frame) override {
    const std::lock_guard lock(state_->mutex);
    const bool dead = state_->bus == CanBusState::down || state_->bus == CanBusState::bus_off;
    if (dead || state_->refusals > 0) {
      if (!dead) --state_->refusals;
      ++port_.status.send_refused;
      port_.status.last_error = dead ? "the bus is off" : "the transmit queue is full";
      return false;
    }
    ++port_.status.sent;
    if (!state_->filter) {
      state_->deliver(frame, &port_);
    } else {
      for (const CanFrame& instead : state_->filter(frame)) state_->deliver(instead, &port_);
    }
    return true;
  }

  // The other endpoints count what this one lost, so this takes the lock of the bus.
  [[nodiscard]] const CanChannelStatus& status() const override {
    const std::lock_guard lock(state_->mutex);
    status_ = port_.status;
    status_.bus = state_->bus;
    return status_;
  }

 private:
  void take(ReceivedCanFrame& frame, Timestamp now) {
    frame = {port_.queue.front().frame, now};
    port_.queue.pop_front();
    if (frame.frame.error) {
      ++port_.status.error_frames;
      port_.status.last_error = error_words(frame.frame);
    } else {
      ++port_.status.received;
    }
  }

  std::shared_ptr<State> state_;
  State::Port port_;
  mutable CanChannelStatus status_;  // what status() returned last
};

VirtualCanBus::VirtualCanBus(std::size_t queue) : state_(std::make_shared<State>()) {
  state_->capacity = std::max<std::size_t>(queue, 1);
}
VirtualCanBus::~VirtualCanBus() = default;

std::unique_ptr<CanChannel> VirtualCanBus::connect() { return std::make_unique<Member>(state_); }

void VirtualCanBus::set_state(CanBusState bus) {
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->bus == bus) return;
    state_->bus = bus;
  }
  if (bus == CanBusState::bus_off) inject_error(CAN_ERR_BUSOFF);
  if (bus == CanBusState::active) inject_error(CAN_ERR_RESTARTED);
}

void VirtualCanBus::inject_error(std::uint32_t error_class) {
  CanFrame frame;
  frame.id = error_class;
  frame.error = true;
  frame.length = 8;
  inject(frame);
}

void VirtualCanBus::inject(const CanFrame& frame) {
  const std::lock_guard lock(state_->mutex);
  state_->deliver(frame, nullptr);
}

void VirtualCanBus::set_filter(Filter filter) {
  const std::lock_guard lock(state_->mutex);
  state_->filter = std::move(filter);
}

void VirtualCanBus::set_delay(Nanoseconds delay) {
  const std::lock_guard lock(state_->mutex);
  state_->delay = delay;
}

void VirtualCanBus::refuse_sends(std::size_t count) {
  const std::lock_guard lock(state_->mutex);
  state_->refusals = count;
}

}  // namespace cellmirror::can
