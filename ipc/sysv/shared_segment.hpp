// System V shared memory: a segment that the gateway makes and owns, and one that somebody attaches to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "ipc/sysv/key_lock.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

struct SegmentUsers {
  bool gone = false;              // removed under us (log-out, ipcrm)
  std::uint64_t attached = 0;     // processes, ourselves included
  std::int32_t last_process = 0;  // that attached or detached last
};

class SharedSegment {
 public:
  struct Options {
    std::string purpose;  // for messages, e.g. "haptic device of LAP_LEFT"
    std::int32_t key = 0;
    std::size_t bytes = 0;
    std::uint32_t mode = 0600;
    std::string instance = "default";
  };

  // Makes the segment, zeroed. One that is there already (left behind, or made by the device's process before us) is
  // taken where it belongs to this user, lets in nobody beyond `mode` and is large enough; else refused, with the
  // remedy. A key that another gateway holds is refused with its name.
  static Result<std::unique_ptr<SharedSegment>> make(Options options);
  // Detaches and removes it: those who are attached keep the memory until they let go.
  ~SharedSegment();
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;

  // At least page-aligned; as many bytes as were asked for. Constant while this lives.
  [[nodiscard]] std::span<std::byte> memory() const;
  [[nodiscard]] const Options& options() const;
  // A system call: not for the tick.
  [[nodiscard]] SegmentUsers users() const;

 private:
  struct State;
  explicit SharedSegment(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// The other side: simulators and tests.
class AttachedSegment {
 public:
  // Refused where nobody has made it, it belongs to somebody else, or is smaller than `bytes`.
  static Result<AttachedSegment> attach(std::int32_t key, std::size_t bytes, bool read_only);
  ~AttachedSegment();
  AttachedSegment(AttachedSegment&& other) noexcept;
  AttachedSegment& operator=(AttachedSegment&& other) noexcept;
  AttachedSegment(const AttachedSegment&) = delete;
  AttachedSegment& operator=(const AttachedSegment&) = delete;

  [[nodiscard]] std::span<std::byte> memory() const { return memory_; }
  // The one who made it has removed it: attach anew.
  [[nodiscard]] bool removed() const;

 private:
  AttachedSegment(std::span<std::byte> memory, int id) : memory_(memory), id_(id) {}
  std::span<std::byte> memory_;
  int id_ = -1;
};

}  // namespace cellmirror
