// Finds the gateway's shared memory, waits for it, and notices that it was removed: the gateway may come and go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ipc/sysv/shared_segment.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

class SegmentSeeker {
 public:
  SegmentSeeker(std::int32_t key, std::size_t bytes, bool read_only)
      : key_(key), bytes_(bytes), read_only_(read_only) {}

  // Polls by system calls: attaches to a segment that exists, and detaches from a removed one. True while attached.
  // `memory()` may have moved after a call.
  bool look(Timestamp now);
  [[nodiscard]] std::span<std::byte> memory() const { return segment_ ? segment_->memory() : std::span<std::byte>{}; }
  [[nodiscard]] std::uint64_t attachments() const { return attachments_; }
  // Why there is none; empty while attached.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::int32_t key_;
  std::size_t bytes_;
  bool read_only_;
  std::optional<AttachedSegment> segment_;
  Timestamp next_look_;
  std::uint64_t attachments_ = 0;
  std::string reason_;
};

}  // namespace cellmirror::sim
