// Channels of the gateway in virtual time, each from the bytes of its messages to what the gateway says about them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"

namespace cellmirror::faults {

enum class Content {
  good,           // message n as its sender means it
  corrupt,        // with one bit of the value flipped
  foreign,        // of another sender: another value
  other_address,  // meant for another receiver: another value
};

// Message n (counted from 0) is received at `time`.
struct Event {
  Timestamp time;
  unsigned n = 0;
  Content content = Content::good;
};

class Channel {
 public:
  virtual ~Channel() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void receive(const Event& event) = 0;
  // What the gateway says at `now` that it does not say of a sound channel, in one word; empty: nothing. Once said, a
  // count stays said.
  [[nodiscard]] virtual std::string finding(Timestamp now) = 0;
};

// rad: what the sender of message n means; and what any other one does.
[[nodiscard]] double value_of(unsigned n, Content content);

[[nodiscard]] std::unique_ptr<Channel> make_cia402_channel();
[[nodiscard]] std::unique_ptr<Channel> make_protected_dbc_channel();
[[nodiscard]] std::unique_ptr<Channel> make_dds_channel();
[[nodiscard]] std::unique_ptr<Channel> make_rtde_channel();
[[nodiscard]] std::unique_ptr<Channel> make_script_channel();
[[nodiscard]] std::unique_ptr<Channel> make_haptic_channel();

}  // namespace cellmirror::faults
