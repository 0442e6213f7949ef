// The shared memory that tells of the force at the TCP (key 1313), between the thread that makes it, the one that
// writes it, and status.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "app/snapshot/tcp_force_channel.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "ipc/wire/tcp_force_block.hpp"

namespace cellmirror::app {

class TcpForceMemory final : public TcpForceChannel {
 public:
  explicit TcpForceMemory(std::unique_ptr<SharedSegment> segment) : segment_(std::move(segment)) {}
  ~TcpForceMemory() override { end_tcp_force(segment_->memory()); }
  TcpForceMemory(const TcpForceMemory&) = delete;
  TcpForceMemory& operator=(const TcpForceMemory&) = delete;

  // Of the one writer.
  void write(const TcpForce& force) override {
    write_tcp_force(segment_->memory(), force);
    const std::scoped_lock lock(mutex_);
    const bool was_beyond = (report_.newest.flags & kTcpForceBeyondLimit) != 0;
    const bool is_beyond = (force.flags & kTcpForceBeyondLimit) != 0;
    if (!was_beyond && is_beyond) ++report_.times_beyond;
    if (is_beyond) report_.beyond = force;
    report_.newest = force;
  }

  // Any thread.
  [[nodiscard]] TcpForceReport report() const override {
    const std::scoped_lock lock(mutex_);
    return report_;
  }

  // Of the maker.
  [[nodiscard]] SharedSegment& segment() { return *segment_; }
  [[nodiscard]] std::int32_t key() const override { return segment_->options().key; }

 private:
  std::unique_ptr<SharedSegment> segment_;
  mutable std::mutex mutex_;
  TcpForceReport report_;
};

}  // namespace cellmirror::app
