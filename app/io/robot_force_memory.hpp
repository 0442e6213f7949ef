// A plain buffer of float32 in shared memory: force and joint torques of one robot (rob_ela_shm with a size that holds
// no haptic device), between the owner of the cell, who makes it, and the worker that writes.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "app/snapshot/robot_force_channel.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "ipc/wire/haptic_block.hpp"

namespace cellmirror::app {

class RobotForceMemory final : public RobotForceChannel {
 public:
  explicit RobotForceMemory(std::unique_ptr<SharedSegment> segment) : segment_(std::move(segment)) {}
  ~RobotForceMemory() override { close(); }
  RobotForceMemory(const RobotForceMemory&) = delete;
  RobotForceMemory& operator=(const RobotForceMemory&) = delete;

  void write(const Eigen::Vector3d& force_T, std::span<const double> torques) override {
    HapticOutput output;
    output.force_E = force_T;
    output.joint_count = static_cast<std::uint8_t>(std::min(torques.size(), output.joint_torques.size()));
    std::ranges::copy(torques.first(output.joint_count), output.joint_torques.begin());
    const std::scoped_lock lock(mutex_);
    if (segment_) write_haptic_output(segment_->memory(), output);
  }

  // The rest is the maker's.
  // Leaves zeros and releases the key, although snapshots may still hold this; write() has no effect from then on.
  void close() {
    const std::scoped_lock lock(mutex_);
    if (segment_) write_haptic_output(segment_->memory(), HapticOutput());
    segment_.reset();
  }
  // After a removal by another process: makes it again. Returns who uses it.
  Result<SegmentUsers> follow() {
    const std::scoped_lock lock(mutex_);
    if (!segment_) return SegmentUsers();
    if (segment_->users().gone) {
      if (auto renewed = segment_->renew(); !renewed) return std::unexpected(renewed.error());
    }
    return segment_->users();
  }
  [[nodiscard]] std::uint64_t renewed() const {
    const std::scoped_lock lock(mutex_);
    return segment_ ? segment_->renewed() : 0;
  }

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<SharedSegment> segment_;
};

}  // namespace cellmirror::app
