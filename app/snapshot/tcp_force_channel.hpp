// The force at the tool centre point, from the worker that computes it to the shared memory of key 1313.
#pragma once

#include <cstdint>

#include "ipc/wire/tcp_force_block.hpp"

namespace cellmirror::app {

struct TcpForceReport {
  TcpForce newest;
  TcpForce beyond;                 // the newest beyond a limit of SET_TORQUE_LIMIT; sequence 0: none was
  std::uint64_t times_beyond = 0;  // times that such a limit was exceeded
};

class TcpForceChannel {
 public:
  virtual ~TcpForceChannel() = default;
  // One writer.
  virtual void write(const TcpForce& force) = 0;
  // Any thread.
  [[nodiscard]] virtual TcpForceReport report() const = 0;
  // System V key of the memory. Any thread.
  [[nodiscard]] virtual std::int32_t key() const = 0;
};

}  // namespace cellmirror::app
