// A TCP connection to a controller that never blocks longer than its caller allows. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::rtde {

class TcpConnection {
 public:
  // Begins to connect; established() tells when it is done. `address`: numeric, IPv4 or IPv6.
  Result<void> connect(const std::string& address, std::uint16_t port);
  void close();
  [[nodiscard]] bool established() const { return established_; }

  // Bytes received, 0 where none came within `timeout`. Fails where the connection is refused, reset or ended.
  Result<std::size_t> receive(std::span<std::uint8_t> to, Nanoseconds timeout);
  // Sent as the peer takes them, at the latest by the next receive(); what waits is bounded: requests are short.
  void send(std::span<const std::uint8_t> bytes);

 private:
  Result<void> finish_connecting();
  Result<void> flush();

  Descriptor socket_;
  bool established_ = false;
  std::vector<std::uint8_t> waiting_;
};

}  // namespace cellmirror::rtde
