// The shared memory that tells of the force at the TCP (key 1313), between the thread that makes it, the one that
// writes it, and status.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "ipc/sysv/shared_segment.hpp"
#include "ipc/wire/tcp_force_block.hpp"

namespace cellmirror::app {

struct TcpForceReport {
  TcpForce newest;
  TcpForce beyond;                 // the newest beyond a limit of SET_TORQUE_LIMIT; sequence 0: none was
  std::uint64_t times_beyond = 0;  // that such a limit was passed
};

class TcpForceMemory {
 public:
  explicit TcpForceMemory(std::unique_ptr<SharedSegment> segment) : segment_(std::move(segment)) {}
  ~TcpForceMemory() { write_tcp_force(segment_->memory(), TcpForce()); }
  TcpForceMemory(const TcpForceMemory&) = delete;
  TcpForceMemory& operator=(const TcpForceMemory&) = delete;

  // Of the one writer.
  void write(const TcpForce& force) {
    write_tcp_force(segment_->memory(), force);
    const std::scoped_lock lock(mutex_);
    const bool was_beyond = (report_.newest.flags & kTcpForceBeyondLimit) != 0;
    const bool is_beyond = (force.flags & kTcpForceBeyondLimit) != 0;
    if (!was_beyond && is_beyond) ++report_.times_beyond;
    if (is_beyond) report_.beyond = force;
    report_.newest = force;
  }

  // Any thread.
  [[nodiscard]] TcpForceReport report() const {
    const std::scoped_lock lock(mutex_);
    return report_;
  }

  // Of the maker.
  [[nodiscard]] SharedSegment& segment() { return *segment_; }
  [[nodiscard]] const SharedSegment::Options& options() const { return segment_->options(); }

 private:
  std::unique_ptr<SharedSegment> segment_;
  mutable std::mutex mutex_;
  TcpForceReport report_;
};

}  // namespace cellmirror::app
