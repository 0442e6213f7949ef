// A CAN bus in memory for tests: any number of endpoints in one process, and every fault of a real bus on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

// Thread-safe. Endpoints keep the bus's state alive; they may outlive the bus object.
class VirtualCanBus {
 public:
  // `queue`: frames that an endpoint holds before the oldest is dropped and counted (receive_dropped).
  explicit VirtualCanBus(std::size_t queue = 4096);
  ~VirtualCanBus();
  VirtualCanBus(const VirtualCanBus&) = delete;
  VirtualCanBus& operator=(const VirtualCanBus&) = delete;

  // A new endpoint. It receives what the others send, not its own frames.
  [[nodiscard]] std::unique_ptr<CanChannel> connect();

  // bus_off: frames are refused and none arrives, an error frame reports it; active: a restart; down: as ENETDOWN.
  void set_state(CanBusState state);
  // To all endpoints, as if the controller had reported it. `error_class`: CAN_ERR_* of linux/can/error.h.
  void inject_error(std::uint32_t error_class);
  // To all endpoints, as if another device had sent it.
  void inject(const CanFrame& frame);
  // Decides for each frame what arrives instead of it: nothing (loss), itself, several (repetition, insertion).
  using Filter = std::function<std::vector<CanFrame>(const CanFrame&)>;
  void set_filter(Filter filter);
  // Frames arrive this much later than they were sent; 0 by default.
  void set_delay(Nanoseconds delay);
  // The next `count` sends of every endpoint are refused, as by ENOBUFS.
  void refuse_sends(std::size_t count);

 private:
  struct State;
  class Member;
  std::shared_ptr<State> state_;
};

}  // namespace cellmirror::can
